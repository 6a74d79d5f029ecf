// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "command_line/output_options.hpp"
#include "commands.hpp"
#include "models_option.hpp"
#include "report/html_report.hpp"
#include "rhizodont/models.hpp"
#include "rhizodont/segment.hpp"
#include "serve/service.hpp"

#include <fmt/core.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace rhizodont::command_line {
namespace {

struct ServeCommand {
  int port = 8080;
  std::string models;
  OutputOptions said;
};

/// Ctrl-C, a closed terminal and the system's end are an ordinary end here.
sigset_t ending_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) sigaddset(&signals, signal);
  return signals;
}

void run(const ServeCommand& command) {
  const sigset_t signals = ending_signals();
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);  // before there are threads: all of them leave these to this one
  serve::ServiceOptions options;
  if (!command.said.is_quiet()) options.log = [](const std::string& line) { fmt::print(stderr, "{}\n", line); };
  const std::filesystem::path models = models_folder(command.models, command.said);
  std::vector<std::filesystem::path> weights = model_files(models);
  if (SegmentModels::are_in(models)) {
    options.finder = std::make_shared<const SegmentModels>(SegmentModels::load(models));
    for (const std::filesystem::path& file : segment_model_files(models)) weights.push_back(file);
  }
  options.model_hashes = hashes_of(weights);
  serve::Service service(CompletionModels::load(models), options);
  const int port = service.bind(command.port);
  fmt::print("http://127.0.0.1:{}/ is open in this machine's browsers alone; Ctrl-C ends it\n", port);
  std::fflush(stdout);
  std::thread answering([&service] { service.run(); });
  int signal = 0;
  sigwait(&signals, &signal);
  service.stop();
  answering.join();
}

}  // namespace

void add_serve_command(CLI::App& app) {
  auto command = std::make_shared<ServeCommand>();
  CLI::App* serve = app.add_subcommand("serve", "A page in the browser to look and work with, on this machine alone");
  serve->add_option("--port", command->port, "Port on 127.0.0.1, 1 to 65535; 0: any that is free")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  add_models_option(*serve, command->models);
  command->said.add_to(*serve);
  serve->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
