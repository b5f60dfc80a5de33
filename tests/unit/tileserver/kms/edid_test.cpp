// SPDX-License-Identifier: MIT
#include "tileserver/kms/edid.h"

#include <gtest/gtest.h>

#include <span>
#include <string>

#include "tests/unit/tileserver/kms/edid_data.h"

namespace wall::tileserver {
namespace {

constexpr std::uint8_t kName = 0xfc, kSerialNumber = 0xff;

class Edid {
public:
    Edid& text(std::uint8_t kind, std::string_view text, std::size_t at = test::kSecondDescriptor) {
        test::add_text(data, kind, text, at);
        return *this;
    }
    std::string name(std::size_t size = sizeof(test::EdidData), std::uint8_t sum = 0) {
        test::put_sum_right(data, sum);
        return monitor_name(std::as_bytes(std::span(data).first(size)));
    }
    test::EdidData data = test::edid_without_name();
};

TEST(MonitorName, IsItsDescriptors) {
    EXPECT_EQ(Edid().text(kName, "DELL U2720Q\n ").name(), "DELL U2720Q");
    EXPECT_EQ(Edid().text(kName, "thirteen char").name(), "thirteen char") << "without an end of the line";
    EXPECT_EQ(Edid().text(kName, "last\n", 108).name(), "last");
    EXPECT_EQ(Edid().text(kSerialNumber, "SERIAL\n").text(kName, "Name\n", 90).name(), "Name");
}

TEST(MonitorName, IsTheMakersNumberWithoutOne) {
    EXPECT_EQ(Edid().name(), "DEL a0b1");
    EXPECT_EQ(Edid().text(kName, "\n").name(), "DEL a0b1");
    Edid odd;
    odd.data[8] = odd.data[9] = 0xff;
    EXPECT_EQ(odd.name(), "??? a0b1");
}

TEST(MonitorName, IsPrintable) { EXPECT_EQ(Edid().text(kName, "a\x1b[31m\xe4\x7f\n").name(), "a?[31m??"); }

TEST(MonitorName, IsEmptyWhereTheDataAreNone) {
    EXPECT_EQ(monitor_name({}), "");
    for (std::size_t size = 0; size < sizeof(test::EdidData); ++size) EXPECT_EQ(Edid().name(size), "") << size;
    EXPECT_EQ(Edid().name(sizeof(test::EdidData), 1), "") << "its sum is wrong";
    Edid other;
    other.data[0] = 1;
    EXPECT_EQ(other.name(), "");
}

}  // namespace
}  // namespace wall::tileserver
