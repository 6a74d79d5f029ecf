// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// Signals at every step of writing: the writer is stopped before each of its calls to the kernel in turn, and meets the
// signal there.
#include "base/child_process.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/output_files.hpp"

#include <sys/ptrace.h>
#include <sys/stat.h>

#include <chrono>
#include <csignal>
#include <thread>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;
using Contents = std::map<std::string, std::string>;
using test::contents_of;

struct Stepped {
  int status = 0;           // as of waitpid
  bool reached = false;     // the step at which the signal was to be sent
  bool is_possible = true;  // processes may watch each other here
};

/// Runs `work` in a child of its own that gets `signal` before its `step`-th call to the kernel.
Stepped run_with_signal(const std::function<void()>& work, int signal, int step) {
  Stepped result;
  const pid_t child = fork();
  if (child == 0) {
    if (ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) _exit(test::cannot_be_set_up);
    raise(SIGSTOP);
    try {
      work();
    } catch (const OutputError&) {
      _exit(6);
    }
    _exit(0);
  }
  waitpid(child, &result.status, 0);
  if (!WIFSTOPPED(result.status)) {
    result.is_possible = false;
    return result;
  }
  ptrace(PTRACE_SETOPTIONS, child, nullptr, PTRACE_O_TRACESYSGOOD | PTRACE_O_EXITKILL);
  bool entering = true;
  for (int steps = 0, pending = 0;;) {
    if (ptrace(PTRACE_SYSCALL, child, nullptr, pending) != 0 && signal != SIGKILL) break;
    pending = 0;
    waitpid(child, &result.status, 0);
    if (!WIFSTOPPED(result.status)) break;
    if (WSTOPSIG(result.status) != (SIGTRAP | 0x80)) {
      pending = WSTOPSIG(result.status);
    } else if (std::exchange(entering, !entering) && steps++ == step) {
      result.reached = true;
      kill(child, signal);
    }
  }
  return result;
}

class InterruptedWriting : public ::testing::Test {
 protected:
  // In the background of a script, and with nohup, a program is started with these signals ignored; then they end
  // nothing.
  InterruptedWriting() {
    for (const int number : {SIGHUP, SIGINT, SIGQUIT}) std::signal(number, SIG_DFL);
    start_anew();
  }

  void start_anew() const {
    fs::remove_all(folder.path() / "results");
    fs::create_directory(folder.path() / "results");
    for (const auto& [name, bytes] : older) folder.write("results/" + name, bytes);
  }

  void write_new() const {
    std::vector<OutputFile> files;
    for (const auto& [name, bytes] : newer) files.push_back({folder.path() / "results" / name, bytes});
    write_output_files(files);
  }

  Contents now() const { return contents_of(folder.path() / "results"); }

  test::TemporaryFolder folder;
  const Contents older{{"report", "older report"}, {"tooth", std::string(10'000, 'o')}};
  const Contents newer{{"confidence", "new confidence"}, {"report", "new report"}, {"tooth", std::string(20'000, 'n')}};
};

TEST_F(InterruptedWriting, AnySignalAtAnyStepLeavesAllOfTheOlderOrAllOfTheNew) {
  for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGUSR1, SIGRTMIN + 3}) {
    int unchanged = 0, written = 0, exits = 0, step = 0;
    // Every step for one signal, every ninth for the others.
    for (bool reached = true; reached; step += signal == SIGTERM ? 1 : 9) {
      start_anew();
      const Stepped outcome = run_with_signal([&] { write_new(); }, signal, step);
      if (!outcome.is_possible) GTEST_SKIP() << "processes may not watch each other here";
      reached = outcome.reached;
      const Contents after = now();
      EXPECT_TRUE(after == older || after == newer) << "signal " << signal << " at step " << step;
      if (!reached) continue;
      if (WIFEXITED(outcome.status)) {
        EXPECT_EQ(WEXITSTATUS(outcome.status), 0);
        ++exits;  // the signal came with the call that ends the process
      } else {
        EXPECT_EQ(WTERMSIG(outcome.status), signal) << "at step " << step;
      }
      ++(after == older ? unchanged : written);
    }
#ifdef __SANITIZE_ADDRESS__
    constexpr int last_calls = 2;  // the sanitizer makes one more
#else
    constexpr int last_calls = 1;
#endif
    EXPECT_LE(exits, last_calls);
    EXPECT_GT(step, 100);
    EXPECT_GT(unchanged, 5);
    EXPECT_GT(written, 5);
  }
}

TEST_F(InterruptedWriting, KilledAtAnyStepNothingIsHalfWritten) {
  int left_behind = 0;
  bool reached = true;
  for (int step = 0; reached; ++step) {
    start_anew();
    const Stepped outcome = run_with_signal([&] { write_new(); }, SIGKILL, step);
    if (!outcome.is_possible) GTEST_SKIP() << "processes may not watch each other here";
    reached = outcome.reached;
    int hidden = 0;
    for (const auto& [name, bytes] : now()) {
      if (name.starts_with(".rhizodont-")) {
        ++hidden;  // between two moves: whole, of older or new contents
        EXPECT_TRUE(bytes == older.at("report") || bytes == newer.at("report") || bytes == newer.at("tooth")) << step;
        continue;
      }
      EXPECT_TRUE(bytes == newer.at(name) || (older.contains(name) && bytes == older.at(name))) << step;
    }
    for (const auto& [name, bytes] : older) EXPECT_TRUE(now().contains(name)) << name << " at step " << step;
    left_behind += hidden > 0 ? 1 : 0;
  }
  EXPECT_LE(left_behind, 15);
}

TEST_F(InterruptedWriting, KilledWhileANewFileIsWrittenNothingStays) {
  bool reached = true;
  for (int step = 0; reached; ++step) {
    fs::remove_all(folder.path() / "results");
    fs::create_directory(folder.path() / "results");
    const Stepped outcome = run_with_signal(
        [&] {
          write_output_files({{folder.path() / "results" / "tooth", "new"}});
        },
        SIGKILL, step);
    if (!outcome.is_possible) GTEST_SKIP() << "processes may not watch each other here";
    reached = outcome.reached;
    const Contents after = now();
    EXPECT_TRUE(after.empty() || after == (Contents{{"tooth", "new"}})) << step;
  }
}

TEST_F(InterruptedWriting, AFifoThatNobodyReadsCanBeLeft) {
  const fs::path pipe = folder.path() / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const pid_t child = fork();
  if (child == 0) {
    signal(SIGINT, SIG_DFL);  // which a shell that starts the tests in the background has ignored
    write_output_files({{folder.path() / "results" / "tooth", "new"}, {pipe, "new"}});
    _exit(0);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  kill(child, SIGINT);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGINT) << status;
  EXPECT_EQ(now(), older);
}

TEST_F(InterruptedWriting, SignalsThatTheProgramHandlesItselfAreLeftToIt) {
  EXPECT_EQ(test::status_of_child([&] {
              signal(SIGHUP, SIG_IGN);
              write_new();
              return signal(SIGHUP, SIG_DFL) == SIG_IGN && signal(SIGTERM, SIG_DFL) == SIG_DFL ? 0 : 1;
            }),
            0);
  EXPECT_EQ(now(), newer);
}

}  // namespace
}  // namespace rhizodont
