// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/io.hpp"

#include <string_view>

// What tells the kinds of STL files apart, for the reader and for telling formats apart.
namespace rhizodont {

/// The size is just the one that the count of triangles asks for. No file of another kind does that by chance.
bool is_exact_binary_stl(std::string_view bytes);

/// Header and triangles, but more or fewer than announced.
bool is_binary_stl_of_other_size(std::string_view bytes);

/// Text that begins with `solid` or `facet`, after comments, colours or a byte order mark. Many binary files begin with
/// "solid" too: text has no zero bytes and goes on with a keyword.
bool is_stl_text(std::string_view bytes);

/// STL as text, in all dress: any case, comments (#, //, ;), colours, without `solid`, without normals, "end loop",
/// several solids, anything after the end.
MeshFile read_stl_text(std::string_view text);

}  // namespace rhizodont
