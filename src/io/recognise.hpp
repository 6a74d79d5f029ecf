// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

namespace rhizodont {

/// What is read.
enum class MeshFormat { stl, ply, obj, off, vtp, vtk };

/// The format of a file by its first bytes and its structure. `ending` (".stl", in lower case, possibly empty) decides
/// only where the content leaves it open. Throws InputError, with the name of what it is where that is known, for
/// everything that is not read. Precondition: not empty, no byte order mark, no compression.
MeshFormat recognise(std::string_view bytes, std::string_view ending);

/// Whether the bytes look like a text of one byte per letter: no zero bytes and hardly any control characters among the
/// first 4096.
bool is_text(std::string_view bytes);

}  // namespace rhizodont
