// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "command_line/program.hpp"

namespace rhizodont::command_line {

// Each command is one file command_<name>.cpp; its function adds the subcommand with options and a callback. A callback
// ends by returning (exit code 0), by throwing rhizodont::Error (its code; the sentence goes to standard error), or by
// `exit_with(code)` where everything to be said has been printed.

void add_arch_command(CLI::App& app);
void add_batch_command(CLI::App& app);
void add_complete_command(CLI::App& app);
void add_doctor_command(CLI::App& app);
void add_evaluate_command(CLI::App& app);
void add_check_command(CLI::App& app);
void add_measure_command(CLI::App& app);
void add_register_command(CLI::App& app);
void add_render_command(CLI::App& app);
void add_segment_command(CLI::App& app);
void add_serve_command(CLI::App& app);
void add_synth_command(CLI::App& app);
void add_label_skirt_command(CLI::App& app);

}  // namespace rhizodont::command_line
