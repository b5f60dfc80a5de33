# SPDX-License-Identifier: MIT
"""glgen: gl.xml and proto/gl/*.toml -> typed models (registry, wire, state, commands) -> emitters returning text."""
