// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "batch/manifest.hpp"

#include "base/lower_case.hpp"
#include "batch/csv.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/report.hpp"
#include "rhizodont/root_steering.hpp"
#include "rhizodont/units.hpp"
#include "teeth/fdi.hpp"
#include "teeth/label_numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace rhizodont {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::string_view, 11> known_columns{"scan",         "labels", "label_array", "palette",
                                                         "labels_are",   "jaw",    "first_label", "fdi",
                                                         "root_lengths", "unit",   "id"};

/// A sentence for each line at fault.
class Faults {
 public:
  void add(int line, std::string_view column, std::string_view what) {
    constexpr std::size_t most_told = 10;
    if (++count_ > most_told) return;
    text_ += fmt::format("{}Line {}{}{}: {}.", text_.empty() ? "" : " ", line, column.empty() ? "" : ", column ",
                         column, what);
    told_ = count_;
  }

  void throw_if_any() const {
    if (count_ == 0) return;
    throw InputError(text_ + (count_ > told_ ? fmt::format(" {} more faults follow.", count_ - told_) : ""));
  }

 private:
  std::string text_;
  std::size_t count_ = 0, told_ = 0;
};

std::string trimmed(std::string_view text) {
  constexpr std::string_view blanks = " \t\n\r";
  const std::size_t first = text.find_first_not_of(blanks);
  return first == std::string_view::npos ? ""
                                         : std::string(text.substr(first, text.find_last_not_of(blanks) + 1 - first));
}

char separator_of(std::string_view text) {
  const std::string_view heading = text.substr(0, text.find_first_of("\r\n"));
  for (const char c : {',', ';', '\t'})
    if (heading.find(c) != std::string_view::npos) return c;
  return ',';
}

/// Columns of the table by name. Throws InputError.
std::map<std::string, std::size_t> columns_of(const CsvRecord& heading) {
  Faults faults;
  std::map<std::string, std::size_t> columns;
  for (std::size_t i = 0; i < heading.fields.size(); ++i) {
    const std::string name = lower_case(trimmed(heading.fields[i]));
    const std::string number = std::to_string(i + 1);
    if (std::find(known_columns.begin(), known_columns.end(), name) == known_columns.end())
      faults.add(
          heading.line, number,
          fmt::format("it is named otherwise than a manifest's columns, which are {}", fmt::join(known_columns, ", ")));
    else if (!columns.emplace(name, i).second)
      faults.add(heading.line, number, fmt::format("there are two columns {}", name));
  }
  faults.throw_if_any();
  if (!columns.contains("scan")) faults.add(heading.line, "", "the first line names the columns, and none is scan");
  faults.throw_if_any();
  return columns;
}

/// A length in mm within its bounds.
std::optional<double> length_in(std::string_view text) {
  double mm = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), mm);
  const bool is_length =
      failure == std::errc() && end == text.data() + text.size() && mm >= shortest_root_mm && mm <= longest_root_mm;
  return is_length ? std::optional(mm) : std::nullopt;
}

/// One line as a case, cell by cell.
class CaseReader {
 public:
  CaseReader(const CsvRecord& record, const std::map<std::string, std::size_t>& columns, const fs::path& folder,
             Faults& faults)
      : record_(record), columns_(columns), folder_(folder), faults_(faults) {}

  BatchCase read() {
    case_.line = record_.line;
    read_files();
    read_tooth();
    read_lengths();
    read_words();
    return std::move(case_);
  }

 private:
  std::string cell(const char* column) const {
    const auto found = columns_.find(column);
    return found == columns_.end() ? "" : trimmed(record_.fields[found->second]);
  }

  void fault(const char* column, std::string_view what) { faults_.add(record_.line, column, what); }

  fs::path file(const char* column) const {
    const std::string name = cell(column);
    return name.empty() ? fs::path() : folder_ / name;
  }

  void read_files() {
    case_.scan_as_given = cell("scan");
    case_.scan = file("scan");
    case_.labels.labels = file("labels");
    case_.labels.palette = file("palette");
    case_.labels.array = cell("label_array");
    if (case_.scan.empty()) fault("scan", "there is no file");
    if (!case_.labels.labels.empty() + !case_.labels.palette.empty() + !case_.labels.array.empty() > 1)
      faults_.add(record_.line, "", "labels come from one place, of labels, label_array and palette");
  }

  void read_tooth() {
    const std::string number = cell("fdi");
    case_.is_crown = !number.empty();
    if (!case_.is_crown) return;
    case_.fdi = read_fdi(number);
    if (!case_.fdi && number != "?")
      fault("fdi", "it takes a tooth's number, 11 to 48 or 51 to 85, or ? for a crown whose number is not known");
    if (!case_.labels.labels.empty() || !case_.labels.palette.empty() || !case_.labels.array.empty() ||
        !cell("labels_are").empty() || !cell("jaw").empty() || !cell("first_label").empty())
      fault("fdi", "with a number this is a single crown, which has no labels");
  }

  void read_lengths() {
    const std::string cell_text = cell("root_lengths");
    std::string_view text = cell_text;
    while (!text.empty()) {
      const std::size_t end = std::min(text.find_first_of(" ;\n"), text.size());
      if (end > 0) read_length(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
  }

  void read_length(std::string_view word) {
    const std::size_t sign = word.find('=');
    const bool names_tooth = sign != std::string_view::npos;
    const auto mm = length_in(names_tooth ? word.substr(sign + 1) : word);
    const auto fdi = names_tooth ? read_fdi(word.substr(0, sign)) : case_.fdi;
    if (!mm || (names_tooth && !fdi) || (!names_tooth && !case_.is_crown))
      fault("root_lengths", fmt::format("it takes teeth with their lengths, {} to {} mm, such as 36=14.2 11=13.0",
                                        shortest_root_mm, longest_root_mm));
    else if (case_.is_crown ? case_.root_length.has_value() : !case_.root_lengths.emplace(*fdi, *mm).second)
      fault("root_lengths", "a tooth has two lengths");
    else if (case_.is_crown && names_tooth && fdi != case_.fdi)
      fault("root_lengths", "the length is another tooth's than the crown");
    else if (case_.is_crown)
      case_.root_length = mm;
  }

  /// Cells that take one of some words; what is wrong is said without the word.
  void read_words() {
    if (const std::string word = lower_case(cell("labels_are")); !word.empty()) try {
        case_.labels.numbers = read_label_numbers(word);
      } catch (const UsageError&) {
        fault("labels_are", "it takes fdi, universal, arch14 or arch16");
      }
    if (const std::string word = lower_case(cell("jaw")); word == "upper" || word == "lower")
      case_.labels.jaw = word == "upper" ? Jaw::upper : Jaw::lower;
    else if (!word.empty())
      fault("jaw", "it takes upper or lower");
    if (const std::string word = lower_case(cell("first_label")); word == "right" || word == "left")
      case_.labels.first_is_patients_right = word == "right";
    else if (!word.empty())
      fault("first_label", "it takes right or left");
    if (const std::string word = cell("unit"); !word.empty()) try {
        case_.millimetres_per_unit = millimetres_per_unit(word);
      } catch (const UsageError&) {
        fault("unit", "it takes mm, cm, m, um or in");
      }
    case_.id = cell("id");
    const bool is_plain = std::all_of(case_.id.begin(), case_.id.end(), [](char c) {
      return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '-' || c == '_' ||
             c == '.';
    });
    constexpr std::size_t longest = 64;
    if (!is_plain || case_.id.size() > longest)
      fault("id", fmt::format("it takes up to {} letters, digits, -, _ and .", longest));
  }

  const CsvRecord& record_;
  const std::map<std::string, std::size_t>& columns_;
  const fs::path& folder_;
  Faults& faults_;
  BatchCase case_;
};

}  // namespace

BatchManifest read_manifest(std::string_view text, const fs::path& folder) {
  const std::vector<CsvRecord> records = read_csv(text, separator_of(text));
  if (records.empty())
    throw InputError("The manifest is empty: its first line names the columns, such as scan,labels.");
  const std::map<std::string, std::size_t> columns = columns_of(records.front());
  if (records.size() == 1) throw InputError("The manifest has no case: a line for each follows the names of columns.");
  BatchManifest manifest;
  Faults faults;
  std::map<std::string, int> lines;
  for (std::size_t i = 1; i < records.size(); ++i) {
    const CsvRecord& record = records[i];
    if (record.fields.size() != records.front().fields.size()) {
      faults.add(record.line, "",
                 fmt::format("it has {} fields, and the first line names {} columns", record.fields.size(),
                             records.front().fields.size()));
      continue;
    }
    BatchCase read = CaseReader(record, columns, folder, faults).read();
    read.place = manifest.cases.size();
    if (read.id.empty()) read.id = std::to_string(i);
    if (const auto [first, is_new] = lines.emplace(read.id, read.line); !is_new)
      faults.add(read.line, "id", fmt::format("it is that of line {}", first->second));
    manifest.cases.push_back(std::move(read));
  }
  faults.throw_if_any();
  manifest.sha256 = sha256_of_bytes(text);
  return manifest;
}

}  // namespace rhizodont
