// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command_line/program.hpp"

namespace rhizodont::command_line {

// One file command_<name>.cpp each, as in ../rhizodont.

void add_calibrate_command(CLI::App& app);
void add_completion_command(CLI::App& app);
void add_skirt_command(CLI::App& app);
void add_likeness_command(CLI::App& app);
void add_pose_command(CLI::App& app);
void add_segment_command(CLI::App& app);

}  // namespace rhizodont::command_line
