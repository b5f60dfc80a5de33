// SPDX-License-Identifier: MIT
// GoogleTest, for the tests.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "cmake/precompiled/standard.h"
