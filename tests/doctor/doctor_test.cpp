// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/temporary_folder.hpp"
#include "doctor/examine.hpp"
#include "doctor/machine.hpp"
#include "rhizodont/hash.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

namespace rhizodont::doctor {
namespace {

namespace fs = std::filesystem;

const fs::path shipped = fs::path(RHIZODONT_SOURCE_DIR) / "models";

const ModelFinding& model(const Examination& found, const std::string& name) {
  const auto place =
      std::find_if(found.models.begin(), found.models.end(), [&](const ModelFinding& m) { return m.name == name; });
  if (place == found.models.end()) throw std::runtime_error("no " + name);
  return *place;
}

bool speaks_of(const std::vector<std::string>& sentences, const std::string& words) {
  return std::any_of(sentences.begin(), sentences.end(),
                     [&](const std::string& s) { return s.find(words) != std::string::npos; });
}

/// A folder with the shipped models, to be spoilt.
struct Models : test::TemporaryFolder {
  Models() {
    for (const auto& entry : fs::directory_iterator(shipped))
      fs::copy_file(entry.path(), path() / entry.path().filename());
  }
};

TEST(Doctor, FindsThisMachineWell) {
  const Examination found = examine(shipped);
  EXPECT_TRUE(found.faults.empty()) << found.faults.front();
  EXPECT_FALSE(found.code);
  ASSERT_TRUE(found.self_test);
  EXPECT_GT(found.self_test->crown_triangles, 1000);
  EXPECT_EQ(found.self_test->kept_triangles, found.self_test->crown_triangles);
  EXPECT_GT(found.self_test->root_length_mm, 12);  // a canine's
  EXPECT_LT(found.self_test->root_length_mm, 25);
  const ModelFinding& completion = model(found, "completion.safetensors");
  EXPECT_TRUE(completion.is_needed && completion.is_there && completion.is_shipped);
  EXPECT_EQ(completion.sha256, sha256_of_bytes(test::read_all(shipped / "completion.safetensors")));
  EXPECT_EQ(completion.version, "rhizodont completion 4");
  EXPECT_EQ(completion.bytes, fs::file_size(shipped / "completion.safetensors"));
  EXPECT_FALSE(speaks_of(found.warnings, ".safetensors"));
  const nlohmann::ordered_json json = found;
  EXPECT_EQ(json["well"], true);
  EXPECT_EQ(json["self_test"]["holds"], true);
  EXPECT_EQ(json["models"].size(), found.models.size());
}

TEST(Doctor, ADamagedModelIsAFault) {
  const Models models;
  const fs::path file = models.path() / "completion.safetensors";
  fs::resize_file(file, fs::file_size(file) / 2);
  const Examination found = examine(models.path());
  EXPECT_EQ(found.code, ErrorCode::unusable_input);
  EXPECT_FALSE(model(found, "completion.safetensors").fault.empty());
  EXPECT_TRUE(speaks_of(found.faults, "completion.safetensors cannot be used"));
  EXPECT_FALSE(found.self_test);
  EXPECT_EQ(nlohmann::ordered_json(found)["well"], false);
}

TEST(Doctor, AMissingModelIsAFaultOnlyWhereNothingWorksWithoutIt) {
  const Models models;
  fs::remove(models.path() / "skirt.safetensors");
  Examination found = examine(models.path());
  EXPECT_FALSE(found.code);
  EXPECT_TRUE(speaks_of(found.warnings, "no skirt.safetensors"));
  EXPECT_TRUE(found.self_test && found.self_test->failures.empty());
  fs::remove(models.path() / "likeness.safetensors");
  found = examine(models.path());
  EXPECT_TRUE(found.self_test && found.self_test->failures.empty()) << "a crown is completed without it";
  EXPECT_TRUE(speaks_of(found.warnings, "no likeness.safetensors"));
  EXPECT_FALSE(speaks_of(found.warnings, "what needs it")) << "what a model is for is said of each";
  fs::remove(models.path() / "atlas.safetensors");
  found = examine(models.path());
  EXPECT_EQ(found.code, ErrorCode::unusable_input);
  EXPECT_TRUE(speaks_of(found.faults, "no atlas.safetensors"));
}

TEST(Doctor, OneModelInTheNameOfAnotherIsFound) {
  const Models models;
  fs::copy_file(shipped / "skirt.safetensors", models.path() / "completion.safetensors",
                fs::copy_options::overwrite_existing);
  const Examination found = examine(models.path());
  EXPECT_EQ(found.code, ErrorCode::unusable_input);
  EXPECT_TRUE(speaks_of(found.warnings, "completion.safetensors is not the file that belongs"));
  EXPECT_TRUE(speaks_of(found.faults, "Self test: "));
}

/// A system's files: 8000 MB of memory, 6000 MB of them free.
struct System : test::TemporaryFolder {
  System() { put("proc/meminfo", "MemTotal: 8192000 kB\nMemAvailable: 6144000 kB\n"); }
  void put(const std::string& name, const std::string& text) const {
    fs::create_directories((path() / name).parent_path());
    write(name, text);
  }
  void put_group(const std::string& name, const std::string& most, long held_mb, long files_mb) const {
    const std::string folder = "sys/fs/cgroup/" + name;
    put(folder + "memory.max", most + "\n");
    put(folder + "memory.current", std::to_string(held_mb * 1024 * 1024) + "\n");
    put(folder + "memory.stat",
        "anon 7\nactive_file 9\ninactive_file " + std::to_string(files_mb * 1024 * 1024) + "\nslab 5\n");
  }
  void expect_memory(double all_mb, double free_mb) const {
    const Machine machine = this_machine(path());
    EXPECT_DOUBLE_EQ(machine.memory_mb, all_mb);
    EXPECT_DOUBLE_EQ(machine.free_memory_mb, free_mb);
  }
};

std::string megabytes(long count) { return std::to_string(count * 1024 * 1024); }

TEST(Doctor, MemoryIsThatOfTheMachineWhereNoGroupLimitsIt) {
  const System system;
  system.expect_memory(8000, 6000);
  system.put("proc/self/cgroup", "0::/\n");
  system.put_group("", "max", 5000, 0);
  system.expect_memory(8000, 6000);
  system.put_group("", megabytes(9000), 1000, 0);
  system.expect_memory(8000, 6000);
}

TEST(Doctor, FilesInMemoryThatCanGoAreFree) {
  const System system;
  system.put_group("", megabytes(2000), 1900, 1500);
  system.expect_memory(2000, 1600);
}

TEST(Doctor, TheLeastLimitOfAllGroupsAroundCounts) {
  const System system;
  system.put("proc/self/cgroup", "1:name=systemd:/other\n0::/jobs/job 7/step\n");
  system.put_group("jobs/job 7/step/", "max", 10, 0);
  system.put_group("jobs/job 7/", megabytes(3000), 1000, 0);
  system.put_group("jobs/", megabytes(4000), 3900, 0);  // others fill it
  system.put_group("other/", megabytes(1), 0, 0);
  system.expect_memory(3000, 100);
  system.put_group("jobs/job 7/step/", megabytes(500), 450, 0);
  system.expect_memory(500, 50);
  // A name from outside of the container, which nobody can follow here.
  system.put("proc/self/cgroup", "0::/../jobs/job 7\n");
  system.put_group("", megabytes(700), 100, 0);
  system.expect_memory(700, 600);
}

TEST(Doctor, ReadsWhatTheSystemSays) {
  const std::string text = "MemTotal:       24653104 kB\nMemFree:         1000000 kB\nMemAvailable:   2048 kB\n";
  EXPECT_EQ(meminfo_mb(text, "MemAvailable"), 2);
  EXPECT_DOUBLE_EQ(meminfo_mb(text, "MemTotal").value(), 24653104.0 / 1024);
  EXPECT_FALSE(meminfo_mb(text, "Mem"));
  EXPECT_FALSE(meminfo_mb(text, "SwapTotal"));
  EXPECT_FALSE(meminfo_mb("MemTotal:", "MemTotal"));
  const Machine machine = this_machine();
  EXPECT_GE(machine.processors, 1);
  EXPECT_GE(machine.threads, 1);
  EXPECT_LE(machine.processors, static_cast<int>(std::thread::hardware_concurrency()));
  EXPECT_GT(machine.free_memory_mb, 0);
  EXPECT_LE(machine.free_memory_mb, machine.memory_mb);
  for (const auto& [name, version] : library_versions()) EXPECT_FALSE(version.empty()) << name;
}

}  // namespace
}  // namespace rhizodont::doctor
