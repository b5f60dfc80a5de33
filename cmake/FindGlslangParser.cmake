# SPDX-License-Identifier: MIT
# glslang's parser as an imported target. Debian's glslangConfig.cmake wants SPIRV-Tools and a compiler of programs
# along, which nobody here uses.
include(FindPackageHandleStandardArgs)
find_path(GlslangParser_INCLUDE glslang/Public/ShaderLang.h)
set(GlslangParser_LIBRARIES "")
foreach(part glslang MachineIndependent GenericCodeGen OSDependent OGLCompiler glslang-default-resource-limits)
  find_library(GlslangParser_${part} ${part})
  list(APPEND GlslangParser_needed GlslangParser_${part})
  list(APPEND GlslangParser_LIBRARIES "${GlslangParser_${part}}")
endforeach()
find_package_handle_standard_args(GlslangParser DEFAULT_MSG GlslangParser_INCLUDE ${GlslangParser_needed})
if(GlslangParser_FOUND AND NOT TARGET glslang_parser)
  add_library(glslang_parser INTERFACE IMPORTED)
  set_target_properties(glslang_parser PROPERTIES
    INTERFACE_INCLUDE_DIRECTORIES "${GlslangParser_INCLUDE}" INTERFACE_LINK_LIBRARIES "${GlslangParser_LIBRARIES}")
endif()
