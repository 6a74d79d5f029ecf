// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "commands.hpp"
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
  bool quiet = false;
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
  if (!command.quiet) options.log = [](const std::string& line) { fmt::print(stderr, "{}\n", line); };
  const std::filesystem::path models =
      command.models.empty() ? default_models_folder() : std::filesystem::path(command.models);
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
  serve->add_option("--models", command->models, "Folder with the models");
  serve->add_flag("--quiet", command->quiet, "Do not log requests to standard error");
  serve->callback([command] { run(*command); });
}

}  // namespace rhizodont::command_line
