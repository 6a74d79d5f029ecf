// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// Completes bad crowns one after the other, for scripts/hostile_crowns.py: complete_hostile_crowns SOURCE_FOLDER. Reads
// lines "SAMPLE|KIND|SEED|VERTICES|E|REPAIR" (such as crown_36.stl|holes|7|600|1.5|1) and answers each with a line
// "ready" once the crown is there, and one "OUTCOME|SENTENCE".

#include "common/hostile_crowns.hpp"
#include "common/hostile_outcome.hpp"
#include "rhizodont/io.hpp"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace {

using namespace rhizodont;

std::vector<std::string> fields_of(const std::string& line) {
  std::vector<std::string> fields;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, '|');) fields.push_back(field);
  return fields;
}

/// Samples in other sizes; small ones, which are asked for again, are kept.
class CleanCrowns {
 public:
  explicit CleanCrowns(std::filesystem::path folder) : folder_(std::move(folder)) {}

  TriangleMesh of_size(const std::string& sample, std::size_t vertices) {
    const auto kept = kept_.find({sample, vertices});
    if (kept != kept_.end()) return kept->second;
    TriangleMesh crown = test::resized_to(load_mesh(folder_ / sample).mesh, vertices);
    if (vertices <= 1500) kept_[{sample, vertices}] = crown;
    return crown;
  }

 private:
  std::filesystem::path folder_;
  std::map<std::pair<std::string, std::size_t>, TriangleMesh> kept_;
};

void complete(const std::vector<std::string>& fields, CleanCrowns& clean, const CompletionModels& models) {
  const std::string& sample = fields.at(0);
  const TriangleMesh crown =
      test::hostile_crown(clean.of_size(sample, std::stoul(fields.at(3))), fields.at(1), std::stoull(fields.at(2)));
  CompleteOptions options;
  options.fdi = std::stoi(sample.substr(sample.find('_') + 1, 2));
  options.e = std::stod(fields.at(4));
  options.repair = fields.at(5) == "1";
  options.threads = 1;
  std::cout << "ready" << std::endl;
  test::HostileOutcome outcome = test::outcome_of(crown, models, options);
  std::replace(outcome.sentence.begin(), outcome.sentence.end(), '\n', ' ');
  std::cout << test::name_of(outcome.kind) << '|' << outcome.sentence << std::endl;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 2) {
      std::cerr << "usage: complete_hostile_crowns SOURCE_FOLDER\n";
      return 2;
    }
    const std::filesystem::path source = argv[1];
    CleanCrowns clean(source / "samples");
    const CompletionModels models = CompletionModels::load(source / "models");
    for (std::string line; std::getline(std::cin, line);) complete(fields_of(line), clean, models);
    return 0;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
