// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/held_signals.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <mutex>
#include <utility>
#include <vector>

namespace rhizodont {
namespace {

std::atomic<int> first_noted{0};
static_assert(std::atomic<int>::is_always_lock_free, "a signal handler may use no other");

std::mutex mutex;  // of what follows
int holders = 0;
std::vector<std::pair<int, struct sigaction>> previous;

void note(int signal) {
  int none = 0;
  first_noted.compare_exchange_strong(none, signal);
}

/// Those whose default is to end the program, but for faults of the program itself (SIGSEGV, ...), SIGABRT and SIGKILL.
std::vector<int> ending_signals() {
  std::vector<int> signals{SIGHUP,  SIGINT,  SIGQUIT, SIGTERM,   SIGALRM, SIGVTALRM, SIGPROF,
                           SIGUSR1, SIGUSR2, SIGPOLL, SIGSTKFLT, SIGPWR,  SIGXCPU};
  for (int signal = SIGRTMIN; signal <= SIGRTMAX; ++signal) signals.push_back(signal);
  return signals;
}

void take_over(int signal, void (*handler)(int)) {
  struct sigaction before {};
  if (sigaction(signal, nullptr, &before) != 0 || (before.sa_flags & SA_SIGINFO) != 0 || before.sa_handler != SIG_DFL)
    return;
  struct sigaction action {};
  action.sa_handler = handler;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  if (sigaction(signal, &action, nullptr) == 0) previous.emplace_back(signal, before);
}

}  // namespace

HeldSignals::HeldSignals() {
  const std::lock_guard lock(mutex);
  if (holders++ > 0) return;
  for (const int signal : ending_signals()) take_over(signal, note);
  for (const int signal : {SIGPIPE, SIGXFSZ}) take_over(signal, SIG_IGN);
}

HeldSignals::~HeldSignals() {
  int signal = 0;
  {
    const std::lock_guard lock(mutex);
    if (--holders > 0) return;
    for (const auto& [number, action] : previous) sigaction(number, &action, nullptr);
    previous.clear();
    signal = first_noted.exchange(0);
  }
  if (signal != 0) std::raise(signal);
}

bool HeldSignals::noted() { return first_noted.load() != 0; }

}  // namespace rhizodont
