// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"

int main(int argc, char** argv) {
  using namespace rhizodont::command_line;
  const Program program{"rhizodont-train",
                        "Trains the networks of rhizodont on generated teeth.",
                        {add_completion_command, add_calibrate_command, add_skirt_command, add_likeness_command,
                         add_pose_command, add_segment_command},
                        {}};
  return run_program(program, argc, argv);
}
