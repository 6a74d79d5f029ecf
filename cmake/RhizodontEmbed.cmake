# SPDX-FileCopyrightText: Rhizodont contributors
# SPDX-License-Identifier: GPL-3.0-or-later

# Files as part of a program: writes a source with `const std::vector<Asset>& rhizodont::<function>()` (base/asset.hpp), which
# gives their names and bytes. The assembler takes the bytes as they are, which costs no time.
#   rhizodont_embed(<source.cpp> <function> <name>=<file> ...)   # the files may still have to be made
function(rhizodont_embed source function)
  set(blocks "")
  set(declarations "")
  set(entries "")
  set(files "")
  set(number 0)
  foreach(pair IN LISTS ARGN)
    string(REGEX MATCH "^([^=]+)=(.+)$" matched "${pair}")
    set(symbol rhizodont_${function}_${number})
    string(APPEND blocks "__asm__(\".section .rodata\\n.balign 16\\n.global ${symbol}\\n.hidden ${symbol}\\n${symbol}:\\n.incbin \\\"${CMAKE_MATCH_2}\\\"\\n"
                         ".global ${symbol}_end\\n.hidden ${symbol}_end\\n${symbol}_end:\\n.byte 0\\n.previous\\n\");\n")
    string(APPEND declarations "extern \"C\" const char ${symbol}[], ${symbol}_end[];\n")
    string(APPEND entries "      {\"${CMAKE_MATCH_1}\", {${symbol}, static_cast<std::size_t>(${symbol}_end - ${symbol})}},\n")
    list(APPEND files ${CMAKE_MATCH_2})
    math(EXPR number "${number} + 1")
  endforeach()
  file(CONFIGURE OUTPUT ${source} @ONLY CONTENT "// written by CMake: cmake/RhizodontEmbed.cmake
#include \"base/asset.hpp\"

#include <cstddef>
#include <vector>

${blocks}
${declarations}
namespace rhizodont {

const std::vector<Asset>& ${function}();

const std::vector<Asset>& ${function}() {
  static const std::vector<Asset> all{
${entries}  };
  return all;
}

}  // namespace rhizodont
")
  set_source_files_properties(${source} PROPERTIES OBJECT_DEPENDS "${files}" SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()
