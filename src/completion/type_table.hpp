// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace rhizodont {

/// Numbers of tooth types, by the FDI number of the type's left tooth (21-28, 31-38), as a weight file's metadata holds
/// them in one line: "1; 21 -1.05 1.29; 22 ...", where 1 is the version of that form.
using TypeTable = std::map<int, std::vector<double>>;

/// The line, four digits after the point. Precondition: the numbers are finite.
std::string type_table_text(const TypeTable& table);

/// Reads it. `name` is what the metadata calls it. Throws InputError for another version and for a line that does not
/// have `columns` finite numbers for each of its types.
TypeTable read_type_table(const std::string& text, std::size_t columns, const std::string& name);

}  // namespace rhizodont
