// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/scan_input.hpp"

#include "base/lower_case.hpp"
#include "mesh/append_mesh.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/report.hpp"
#include "rhizodont/tooth_file.hpp"
#include "teeth/fdi.hpp"
#include "teeth/label_numbers.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <charconv>
#include <map>
#include <numeric>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;

bool is_folder(const fs::path& path) {
  std::error_code ignored;
  return fs::is_directory(path, ignored);
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

fs::path beside(const fs::path& scan) {
  fs::path name = scan;
  if (name.extension() == ".gz") name.replace_extension();
  return name.replace_extension(".json");
}

bool is_mesh_name(const fs::path& path) {
  static const std::set<std::string> endings{".stl", ".ply", ".obj", ".off", ".vtp", ".vtk"};
  return endings.contains(lower_case(path.extension().string()));
}

std::vector<fs::path> meshes_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.is_regular_file() && is_mesh_name(entry.path())) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<fs::path> crowns_in(const fs::path& folder) {
  std::vector<fs::path> files = meshes_in(folder);
  std::erase_if(files, [](const fs::path& path) { return !tooth_in_name(path); });
  if (files.empty())
    throw InputError(folder.string() +
                     " has no crown with its tooth's number in the name of the file, such as crown_36.ply or UR1.stl.");
  return files;
}

ScanInput scan_of_folder(const fs::path& folder) {
  ScanInput input;
  input.is_folder = true;
  std::map<int, fs::path> seen;
  for (const fs::path& path : crowns_in(folder)) {
    const int fdi = *tooth_in_name(path);
    if (const auto [first, is_new] = seen.emplace(fdi, path); !is_new)
      throw InputError(fmt::format("{} and {} are both of tooth {}.", first->second.filename().string(),
                                   path.filename().string(), fdi));
    const MeshFile crown = load_mesh(path);
    append_mesh(input.file.mesh, crown.mesh);
    input.scan.fdi.resize(input.file.mesh.vertices.size(), fdi);
    std::vector<int> own = crown.file_vertices;
    if (own.empty()) {
      own.resize(crown.mesh.vertices.size());
      std::iota(own.begin(), own.end(), 0);
    }
    input.file.file_vertices.insert(input.file.file_vertices.end(), own.begin(), own.end());
    input.file.coordinates_fit_float = input.file.coordinates_fit_float && crown.coordinates_fit_float;
    for (const std::string& note : crown.notes) input.notes.push_back(fmt::format("Tooth {}: {}", fdi, note));
  }
  input.scan.mesh = input.file.mesh;
  input.notes.insert(input.notes.begin(),
                     fmt::format("{} crowns, their numbers taken from the files' names.", seen.size()));
  const auto others = meshes_in(folder).size() - seen.size();
  if (others > 0)
    input.notes.push_back(
        fmt::format("{} of the folder's files {} passed over: no name of one tooth alone is in the name.", others,
                    others == 1 ? "was" : "were"));
  return input;
}

/// The bytes of a file beside the scan; its name goes before the sentence of what is wrong with it.
template <class Read>
auto reading(const fs::path& path, const Read& read) {
  try {
    return read(read_file_bytes(path));
  } catch (const InputError& error) {
    throw error.reworded(path.string() + ": " + error.what());
  }
}

std::size_t count_teeth(const std::vector<int>& fdi) {
  std::set<int> teeth(fdi.begin(), fdi.end());
  teeth.erase(0);
  return teeth.size();
}

double teeth_across(const TriangleMesh& mesh, const std::vector<int>& fdi) {
  Eigen::AlignedBox3d box;
  for (std::size_t v = 0; v < fdi.size(); ++v)
    if (fdi[v] != 0) box.extend(mesh.vertices[v]);
  return box.isEmpty() ? 0 : box.diagonal().norm();
}

RawLabels found_labels(const ScanLabelSource& source, double millimetres_per_unit, ScanInput& input) {
  SegmentOptions options;
  options.jaw = source.jaw;
  options.millimetres_per_unit = millimetres_per_unit;
  SegmentedScan found = source.find(input.file.mesh, options);
  input.found = std::move(found.teeth);
  input.notes.push_back(found.jaw_reason);
  input.notes.insert(input.notes.end(), found.notes.begin(), found.notes.end());
  return {std::move(found.fdi), "a search for the teeth in the scan", found.jaw, LabelNumbers::fdi};
}

RawLabels raw_labels(const fs::path& scan, const ScanLabelSource& source, double millimetres_per_unit,
                     ScanInput& input) {
  const MeshFile& file = input.file;
  const auto from_file = [&](const std::string& json) { return labels_from_teeth3ds(json, file); };
  if (!source.labels.empty()) return reading(source.labels, from_file);
  if (!source.palette.empty())
    return labels_from_colours(file,
                               reading(source.palette, [](const std::string& text) { return read_palette(text); }));
  if (!source.array.empty() || has_label_array(file)) return labels_from_array(file, source.array);
  if (!scan.empty() && is_there(beside(scan))) return reading(beside(scan), from_file);
  if (source.find) return found_labels(source, millimetres_per_unit, input);
  throw InputError(
      "Nothing tells this scan's teeth apart: it has no array of labels, no file of labels lies beside it, and no "
      "model to find teeth with is there (segment.safetensors). Name a file (--labels FILE.json), an array "
      "(--label-array "
      "NAME), or what its colours stand for (--palette FILE).");
}

/// Decides what the numbers mean, and cleans them.
void set_labels(ScanInput& input, const RawLabels& raw, const ScanLabelSource& source, double millimetres_per_unit) {
  LabelNumberOptions options;
  options.forced = input.found.empty() ? source.numbers : LabelNumbers::fdi;  // a search gives FDI numbers
  options.stated = raw.stated_numbers;
  options.jaw = source.jaw ? source.jaw : raw.stated_jaw;
  options.first_is_patients_right = source.first_is_patients_right;
  input.scan.mesh = input.file.mesh;
  ScanLabels labels = decide_label_numbers(input.scan.mesh, raw.per_vertex, options);
  input.notes.push_back(fmt::format("Labels from {}. {}", raw.origin, labels.decided));
  TriangleMesh in_millimetres = input.scan.mesh;
  for (Point& p : in_millimetres.vertices) p *= millimetres_per_unit;
  if (has_size_of_arch(teeth_across(in_millimetres, labels.fdi),
                       count_teeth(labels.fdi))) {  // else it will be refused for that
    CleanedLabels cleaned = clean_labels(in_millimetres, labels.fdi);
    for (LabelChange& change : cleaned.changes) {
      change.at /= millimetres_per_unit;  // to be found in the scan
      input.notes.push_back(describe(change));
    }
    labels.fdi = std::move(cleaned.fdi);
  }
  input.scan.fdi = std::move(labels.fdi);
}

/// A scan with the labels of the text of a Teeth3DS file; if that is empty, with those that the source leads to.
ScanInput labelled_scan(const fs::path& path, MeshFile file, std::string sha256, std::string_view teeth3ds,
                        const ScanLabelSource& source, double millimetres_per_unit) {
  ScanInput input;
  input.file = std::move(file);
  input.sha256 = std::move(sha256);
  input.notes = std::move(input.file.notes);
  input.file.notes.clear();
  const RawLabels raw = teeth3ds.empty() ? raw_labels(path, source, millimetres_per_unit, input)
                                         : labels_from_teeth3ds(teeth3ds, input.file);
  try {
    set_labels(input, raw, source, millimetres_per_unit);
  } catch (const InputError& error) {
    throw in_terms_of_file(error, input.file);
  }
  return input;
}

std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view blanks = " \t\v\f\r";
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  return text.substr(0, text.find_last_not_of(blanks) + 1);
}

/// "36,14.2", by hand: the standard library's regular expressions need stack for every letter of a line. Precondition:
/// no blanks around it.
std::optional<std::pair<const int, double>> length_in_line(std::string_view line) {
  constexpr std::string_view digits = "0123456789";
  const auto fdi = read_fdi(std::string(line.substr(0, 2)));
  if (!fdi) return std::nullopt;
  const std::string_view rest = line.substr(2);
  std::string_view number = without_blanks(rest);
  if (number.starts_with(',') || number.starts_with(';'))
    number = without_blanks(number.substr(1));
  else if (number.size() == rest.size())
    return std::nullopt;
  if (number.find_first_not_of("0123456789.") != std::string_view::npos || number.empty() ||
      digits.find(number.front()) == std::string_view::npos || digits.find(number.back()) == std::string_view::npos)
    return std::nullopt;
  double mm = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), mm);
  if (end != number.data() + number.size() || error != std::errc()) return std::nullopt;
  return std::pair<const int, double>(*fdi, mm);
}

}  // namespace

ScanInput read_scan(const fs::path& path, const ScanLabelSource& source, double millimetres_per_unit) {
  const auto given = static_cast<int>(!source.labels.empty()) + static_cast<int>(!source.array.empty()) +
                     static_cast<int>(!source.palette.empty());
  if (given > 1) throw UsageError("Labels come from one place: a file, an array, or colours.");
  if (is_folder(path)) {
    if (given > 0) throw UsageError("The crowns of a folder have their numbers in their names.");
    return scan_of_folder(path);
  }
  std::string sha256;
  MeshFile file = reading(path, [&](const std::string& bytes) {
    sha256 = sha256_of_bytes(bytes);
    return read_mesh(bytes, path);
  });
  return labelled_scan(path, std::move(file), std::move(sha256), {}, source, millimetres_per_unit);
}

ScanInput scan_of_file(MeshFile file, std::string sha256, std::string_view teeth3ds, const ScanLabelSource& source,
                       double millimetres_per_unit) {
  return labelled_scan({}, std::move(file), std::move(sha256), teeth3ds, source, millimetres_per_unit);
}

std::vector<fs::path> files_of_scan(const fs::path& scan, const ScanLabelSource& source) {
  if (is_folder(scan)) return crowns_in(scan);
  std::vector<fs::path> files{scan};
  for (const fs::path* named : {&source.labels, &source.palette})
    if (!named->empty()) files.push_back(*named);
  if (files.size() == 1 && source.array.empty() && is_there(beside(scan))) files.push_back(beside(scan));
  return files;
}

std::optional<int> tooth_in_name(const fs::path& file) {
  const std::string name = lower_case(file.stem().string());
  static const std::regex quadrant("(?:^|[^a-z])([ul])([rl])([1-8])(?![0-9])"), universal("id_([0-9]{1,2})(?![0-9])"),
      digits("(?:^|[^0-9])([1-8][1-8])(?![0-9])");
  std::set<int> found;
  std::smatch match;
  if (std::regex_search(name, match, quadrant)) {
    const bool upper = match[1] == "u", right = match[2] == "r";
    found.insert(10 * (upper ? (right ? 1 : 2) : (right ? 4 : 3)) + (match[3].str()[0] - '0'));
  } else if (std::regex_search(name, match, universal)) {
    if (const auto fdi = fdi_of_universal(std::stoi(match[1]))) found.insert(*fdi);
  } else if (const auto permanent = fdi_in_name(file)) {
    return permanent;
  } else {
    for (std::sregex_iterator i(name.begin(), name.end(), digits), end; i != end; ++i)
      if (const auto fdi = read_fdi((*i)[1].str())) found.insert(*fdi);
  }
  return found.size() == 1 ? std::optional(*found.begin()) : std::nullopt;
}

std::map<int, double> load_root_lengths(const fs::path& path) {
  return reading(path, [](const std::string& text) { return read_root_lengths(text); });
}

std::map<int, double> read_root_lengths(std::string_view text) {
  std::map<int, double> lengths;
  std::istringstream lines{std::string(text)};
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::string_view content = without_blanks(line);
    if (content.empty() || content.front() == '#') continue;
    const auto entry = length_in_line(content);
    if (!entry) {
      if (number == 1 && line.find_first_of("0123456789") == std::string::npos) continue;  // a heading
      throw InputError(
          fmt::format("Line {} of the root lengths is not a tooth and its length in mm, such as 36,14.2.", number));
    }
    if (!lengths.insert(*entry).second)
      throw InputError(fmt::format("Line {} of the root lengths names tooth {} a second time.", number, entry->first));
  }
  return lengths;
}

}  // namespace rhizodont
