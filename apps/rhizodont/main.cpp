// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"

int main(int argc, char** argv) {
  using namespace rhizodont::command_line;
  const Program program{
      "rhizodont",
      "Whole teeth with roots from scanned crowns; the crown is kept to the bit.",
      {add_complete_command, add_arch_command, add_batch_command, add_segment_command, add_evaluate_command,
       add_check_command, add_measure_command, add_render_command, add_serve_command, add_doctor_command,
       add_synth_command, add_register_command, add_label_skirt_command},
      "complete",
      {{"RHIZODONT_MODELS", "Folder with the models, where --models names none"}}};
  return run_program(program, argc, argv);
}
