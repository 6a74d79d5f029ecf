// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rhizodont/output_files.hpp"

#include "base/child_process.hpp"
#include "rhizodont/error.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <thread>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;
using test::contents_of, test::read_all, test::status_of_child;

class OutputFiles : public ::testing::Test {
 protected:
  fs::path at(const std::string& name) const { return folder.path() / name; }

  static mode_t mode_of(const fs::path& path) {
    struct stat status {};
    stat(path.c_str(), &status);
    return status.st_mode & 07777;
  }

  /// Fails with a sentence that holds `words`, and nothing in the folder is another than before.
  void expect_untouched(const std::vector<OutputFile>& files, const std::string& words) const {
    const auto before = contents_of(folder.path());
    try {
      write_output_files(files);
      ADD_FAILURE() << "written, expected: " << words;
    } catch (const OutputError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what() << "\nshould hold: " << words;
    }
    EXPECT_EQ(contents_of(folder.path()), before);
  }

  /// Runs in a process of its own on a file system that has been prepared.
  static void expect_in_child(const std::function<int()>& work) {
    const int status = status_of_child(work);
    ASSERT_TRUE(WIFEXITED(status)) << "ended by signal " << WTERMSIG(status);
    if (WEXITSTATUS(status) == test::cannot_be_set_up) GTEST_SKIP() << "not allowed here";
    EXPECT_EQ(WEXITSTATUS(status), 0);
  }

  test::TemporaryFolder folder;
};

TEST_F(OutputFiles, NewAndOlderFilesAppearTogether) {
  folder.write("b", "older");
  write_output_files({{at("a"), "1"}, {at("b"), "2"}, {at("c"), ""}});
  EXPECT_EQ(contents_of(folder.path()), (std::map<std::string, std::string>{{"a", "1"}, {"b", "2"}, {"c", ""}}));
  write_output_files({});
}

TEST_F(OutputFiles, ModeOwnerAndOtherNamesStay) {
  const fs::path file = folder.write("a", "older");
  fs::create_hard_link(file, at("same"));
  chmod(file.c_str(), 0604);
  if (geteuid() == 0 && chown(file.c_str(), 12345, 23456) != 0) GTEST_SKIP() << "no owner can be set";
  write_output_files({{file, "new"}, {at("b"), "new"}});
  EXPECT_EQ(mode_of(file), 0604U);
  struct stat status {};
  stat(file.c_str(), &status);
  if (geteuid() == 0) {
    EXPECT_EQ(status.st_uid, 12345U);
    EXPECT_EQ(status.st_gid, 23456U);
  }
  EXPECT_EQ(read_all(at("same")), "older");
  const mode_t mask = umask(0);
  umask(mask);
  EXPECT_EQ(mode_of(at("b")), 0666U & ~mask);
}

TEST_F(OutputFiles, LinksStay) {
  fs::create_directory(at("sub"));
  folder.write("real", "older");
  fs::create_symlink("real", at("link"));
  fs::create_symlink("link", at("over"));
  fs::create_symlink("sub/new", at("dangling"));
  write_output_files({{at("over"), "1"}, {at("dangling"), "2"}});
  EXPECT_TRUE(fs::is_symlink(at("link")) && fs::is_symlink(at("over")) && fs::is_symlink(at("dangling")));
  EXPECT_EQ(read_all(at("real")), "1");
  EXPECT_EQ(read_all(at("sub/new")), "2");
  fs::create_symlink("missing/new", at("away"));
  expect_untouched({{at("real"), "3"}, {at("away"), "3"}}, "the link leads into the folder");
  fs::create_symlink("round", at("round"));
  expect_untouched({{at("real"), "3"}, {at("round"), "3"}}, "circle");
}

TEST_F(OutputFiles, AFailedMoveTakesTheOthersBack) {
  folder.write("a", "older a");
  folder.write("d", "older d");
  // The second "c" finds the first one in its place.
  expect_untouched({{at("a"), "1"}, {at("b"), "2"}, {at("c"), "3"}, {at("c"), "4"}, {at("d"), "5"}}, "has appeared");
}

TEST_F(OutputFiles, FoldersAreMadeAndGoAgainOnFailure) {
  expect_untouched({{at("x/y/a"), "1"}, {at("x/z/b"), "2"}, {"/dev/full", "3"}}, "no room");
  write_output_files({{at("x/y/a"), "1"}, {at("x/z/b"), "2"}, {at("x/../w/c"), "3"}});
  EXPECT_EQ(read_all(at("x/y/a")) + read_all(at("x/z/b")) + read_all(at("w/c")), "123");
  expect_untouched({{at("x/y/a/b"), "1"}}, "is a file");
  expect_untouched({{at("x"), "1"}}, "this is a folder");
  expect_untouched({{at("v/"), "1"}}, "this is a folder");
}

TEST_F(OutputFiles, WriteProtectedFilesAreNotReplaced) {
  chmod(folder.write("a", "older").c_str(), 0444);
  expect_untouched({{at("b"), "1"}, {at("a"), "2"}}, "write-protected");
  EXPECT_THROW(require_writable_place(at("a")), OutputError);
}

TEST_F(OutputFiles, LongestNamesWork) {
  const std::string longest(255, 'n');
  for (const char* text : {"1", "2"}) {
    write_output_files({{at(longest), text}, {at("b"), text}});
    EXPECT_EQ(read_all(at(longest)), text);
  }
  expect_untouched({{at("b"), "3"}, {at(longest + "n"), "3"}}, "longer than the disk allows");
  EXPECT_THROW(require_writable_place(at(longest + "n")), OutputError);
}

TEST_F(OutputFiles, DevicesAreWrittenToNotReplaced) {
  fs::create_symlink("/dev/null", at("link"));
  write_output_files({{at("link"), "1"}, {at("a"), "1"}});
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_EQ(read_all(at("a")), "1");
  expect_untouched({{at("a"), "2"}, {"/dev/full", "2"}, {at("b"), "2"}},
                   "/dev/full cannot be written: there is no room");
}

TEST_F(OutputFiles, APipeGetsEverythingAndStays) {
  ASSERT_EQ(mkfifo(at("pipe").c_str(), 0600), 0);
  const std::string bytes(300'000, 'x');
  std::string got;
  std::thread reader([&] { got = read_all(at("pipe")); });
  write_output_files({{at("a"), "1"}, {at("pipe"), bytes}});
  reader.join();
  EXPECT_EQ(got, bytes);
  EXPECT_TRUE(fs::is_fifo(at("pipe")));
}

TEST_F(OutputFiles, AReaderThatGoesAwayIsAFailureNotTheEnd) {
  ASSERT_EQ(mkfifo(at("pipe").c_str(), 0600), 0);
  folder.write("a", "older");
  std::thread reader([&] {
    const int end = open(at("pipe").c_str(), O_RDONLY);
    char byte = 0;
    EXPECT_EQ(read(end, &byte, 1), 1);
    close(end);
  });
  EXPECT_THROW(write_output_files({{at("a"), "1"}, {at("pipe"), std::string(300'000, 'x')}}), OutputError);
  reader.join();
  EXPECT_EQ(read_all(at("a")), "older");
}

TEST_F(OutputFiles, WhatTheShellOpenedIsWrittenToWhateverItIs) {
  folder.write("log", "older\n");
  expect_in_child([&] {
    const int appended = open(at("log").c_str(), O_WRONLY | O_APPEND);
    dup2(appended, STDOUT_FILENO);
    write_output_files({{"/dev/stdout", "new\n"}});
    return 0;
  });
  EXPECT_EQ(read_all(at("log")), "older\nnew\n");
}

TEST_F(OutputFiles, AFullDiskLosesNothing) {
  expect_in_child([&] {
    if (!test::mount_small_disk(folder.path(), "size=256k")) return test::cannot_be_set_up;
    write_output_files({{at("tooth"), std::string(100'000, 'o')}, {at("report"), "older"}});
    expect_untouched({{at("report"), "new"}, {at("tooth"), std::string(200'000, 'n')}}, "no room left");
    expect_untouched({{at("new/one"), "new"}, {at("two"), std::string(200'000, 'n')}}, "no room left");
    folder.write("filler", std::string(300'000, 'f'));
    expect_untouched({{at("report"), "new"}, {at("one"), "new"}}, "no room left");
    return HasFailure() ? 1 : 0;
  });
}

TEST_F(OutputFiles, AReadOnlyDiskIsSaidBeforeTheWork) {
  expect_in_child([&] {
    if (!test::mount_small_disk(folder.path(), "size=256k")) return test::cannot_be_set_up;
    folder.write("tooth", "older");
    if (mount("tmpfs", folder.path().c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, nullptr) != 0)
      return test::cannot_be_set_up;
    for (const char* name : {"tooth", "new", "sub/new"}) {
      expect_untouched({{at(name), "new"}}, "can only be read");
      EXPECT_THROW(require_writable_place(at(name)), OutputError) << name;
    }
    return HasFailure() ? 1 : 0;
  });
}

TEST_F(OutputFiles, TheLimitOfFileSizesIsAFailureNotTheEnd) {
  folder.write("tooth", "older");
  expect_in_child([&] {
    const rlimit limit{50'000, 50'000};
    setrlimit(RLIMIT_FSIZE, &limit);
    expect_untouched({{at("report"), "new"}, {at("tooth"), std::string(60'000, 'n')}}, "larger than a file may become");
    struct sigaction action {};
    sigaction(SIGXFSZ, nullptr, &action);
    EXPECT_EQ(action.sa_handler, SIG_DFL);
    return HasFailure() ? 1 : 0;
  });
}

TEST_F(OutputFiles, SimplerFileSystemsKeepThePromiseToo) {
  folder.write("a", "older a");
  expect_in_child([&] {
    if (!test::pretend_simple_file_system()) return test::cannot_be_set_up;
    expect_untouched({{at("a"), "1"}, {at("b"), "2"}, {at("c"), "3"}, {at("c"), "4"}}, "has appeared");
    write_output_files({{at("a"), "1"}, {at("b"), "2"}});
    write_output_files({{at("b"), "3"}, {at("a"), "4"}});
    EXPECT_EQ(contents_of(folder.path()), (std::map<std::string, std::string>{{"a", "4"}, {"b", "3"}}));
    return HasFailure() ? 1 : 0;
  });
}

TEST_F(OutputFiles, PlacesAreTriedWithoutATrace) {
  folder.write("a", "older");
  const auto before = contents_of(folder.path());
  for (const char* name : {"a", "b", "x/y/z"}) EXPECT_NO_THROW(require_writable_place(at(name)));
  for (const char* name : {"", "a/b", "a/b/c"}) EXPECT_THROW(require_writable_place(at(name)), OutputError) << name;
  EXPECT_THROW(require_writable_place(""), UsageError);
  EXPECT_NO_THROW(require_writable_place("/dev/null"));
  EXPECT_EQ(contents_of(folder.path()), before);
}

}  // namespace
}  // namespace rhizodont
