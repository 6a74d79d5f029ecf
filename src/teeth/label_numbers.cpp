// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "teeth/label_numbers.hpp"

#include "mesh/geometry.hpp"
#include "rhizodont/error.hpp"
#include "teeth/fdi.hpp"
#include "teeth/labelled_arch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace rhizodont {
namespace {

constexpr int universal_gum = 33;
constexpr std::array all_numbers{LabelNumbers::fdi, LabelNumbers::universal, LabelNumbers::arch14,
                                 LabelNumbers::arch16};

bool is_fdi_number(int number) { return is_permanent_tooth(number) || is_milk_tooth(number); }

int arch_length(LabelNumbers numbers) { return numbers == LabelNumbers::arch14 ? 14 : 16; }

/// Whether a number stands for a tooth or for gum.
bool exists_in(LabelNumbers numbers, int number) {
  switch (numbers) {
    case LabelNumbers::fdi:
      return number == 0 || is_fdi_number(number);
    case LabelNumbers::universal:
      return number >= 0 && number <= universal_gum;
    default:
      return number >= 0 && number <= arch_length(numbers);
  }
}

bool is_gum(LabelNumbers numbers, int number) {
  return number == 0 || (numbers == LabelNumbers::universal && number == universal_gum);
}

struct Occurrence {
  std::int64_t vertices = 0;
  double area = 0;
};

/// The numbers of a scan, with how much of it they are on.
class Occurrences {
 public:
  Occurrences(const TriangleMesh& mesh, const std::vector<int>& raw) {
    for (const int number : raw) ++of_number_[number].vertices;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      const double third = triangle_area(mesh, t) / 3;
      for (const std::int32_t v : mesh.triangles[t]) of_number_[raw[static_cast<std::size_t>(v)]].area += third;
      area_ += 3 * third;
    }
  }

  bool has(int number) const { return of_number_.contains(number); }
  double share(int number) const {
    const auto place = of_number_.find(number);
    return place == of_number_.end() || !(area_ > 0) ? 0 : place->second.area / area_;
  }
  template <class Test>
  bool any(const Test& test) const {
    return std::any_of(of_number_.begin(), of_number_.end(), [&](const auto& entry) { return test(entry.first); });
  }
  bool all_exist_in(LabelNumbers numbers) const {
    return !any([&](int number) { return !exists_in(numbers, number); });
  }
  int highest() const { return of_number_.empty() ? 0 : of_number_.rbegin()->first; }
  const std::map<int, Occurrence>& all() const { return of_number_; }

 private:
  std::map<int, Occurrence> of_number_;
  double area_ = 0;
};

struct Decision {
  LabelNumbers numbers = LabelNumbers::fdi;
  std::string reason;
};

const char* long_name(LabelNumbers numbers) {
  switch (numbers) {
    case LabelNumbers::fdi:
      return "FDI numbers";
    case LabelNumbers::universal:
      return "Universal numbers";
    case LabelNumbers::arch14:
      return "numbers 1-14 along the arch";
    case LabelNumbers::arch16:
      break;
  }
  return "numbers 1-16 along the arch";
}

bool source_is_right(LabelNumbers stated, const Occurrences& found) {
  if (!found.all_exist_in(stated)) return false;
  // without its gum, and with FDI numbers alone, an array's name is not enough
  return stated != LabelNumbers::universal || found.has(universal_gum) || !found.all_exist_in(LabelNumbers::fdi);
}

/// Numbers 11-16 alone, which an upper right quadrant has in FDI and the left end of an arch along it.
Decision decide_quadrant(const Occurrences& found, std::optional<Jaw> jaw) {
  const LabelNumbers along = found.highest() <= 14 ? LabelNumbers::arch14 : LabelNumbers::arch16;
  if (jaw == Jaw::lower) return {along, "a lower jaw has no teeth 11-16 in FDI"};
  throw InputError(
      "the labels are 11-16 alone: FDI numbers of the upper right teeth or the end of a count along the arch; say "
      "which "
      "with --labels-are fdi, arch14 or arch16");
}

Decision decide(const Occurrences& found, const LabelNumberOptions& options) {
  using enum LabelNumbers;
  constexpr double hardly_any = 0.05;
  if (options.forced) return {*options.forced, "as was asked for"};
  if (options.stated && source_is_right(*options.stated, found)) return {*options.stated, "as their source says"};
  const auto telling = [](int number) { return number > universal_gum && is_fdi_number(number); };
  if (found.any(telling)) {
    const auto first =
        std::find_if(found.all().begin(), found.all().end(), [&](const auto& x) { return telling(x.first); });
    return {fdi, fmt::format("{} is among them", first->first)};
  }
  const bool up_to_33 = found.all_exist_in(universal);
  const bool is_zero_gum = found.share(0) > hardly_any;
  if (up_to_33 && found.share(universal_gum) > options.gum_share && !is_zero_gum)
    return {universal, fmt::format("33 is on {:.0f} % of the surface, as gum is", 100 * found.share(universal_gum))};
  if (up_to_33 && found.highest() <= 16) {
    if (!found.any([](int number) { return number > 0 && number < 11; })) return decide_quadrant(found, options.jaw);
    return {found.highest() <= 14 ? arch14 : arch16, fmt::format("{} is the highest of them", found.highest())};
  }
  if (found.all_exist_in(fdi)) return {fdi, "all of them are FDI numbers"};
  if (up_to_33 && !found.has(universal_gum)) return {universal, "some of them are no FDI numbers and none is above 32"};
  if (up_to_33) return {universal, "some of them are no FDI numbers and none is above 33"};
  return {fdi, "no other numbering goes so high"};
}

void require_known(const Occurrences& found, LabelNumbers numbers, const std::vector<int>& raw) {
  std::string text;
  for (const auto& [number, occurrence] : found.all())
    if (!exists_in(numbers, number))
      text += fmt::format("{}{} (on {} {})", text.empty() ? "" : ", ", number, occurrence.vertices,
                          occurrence.vertices == 1 ? "vertex" : "vertices");
  if (text.empty()) return;
  std::vector<std::int64_t> ids;
  for (std::size_t v = 0; v < raw.size(); ++v)
    if (!exists_in(numbers, raw[v])) ids.push_back(static_cast<std::int64_t>(v));
  throw InputError(fmt::format("among {} these name no tooth: {}", long_name(numbers), text), std::move(ids),
                   ElementKind::vertices);
}

/// The places of labels along an arch, counted from the patient's right.
struct ArchPlaces {
  bool first_is_right = true;
  std::string reason;
};

ArchPlaces places_along_arch(const TriangleMesh& mesh, const std::vector<int>& raw, const LabelNumberOptions& options) {
  if (options.first_is_patients_right)
    return {*options.first_is_patients_right, fmt::format("label 1 is at the patient's {}, as was asked for",
                                                          *options.first_is_patients_right ? "right" : "left")};
  if (const auto leftward = labels_run_leftward(mesh, raw, *options.jaw)) {
    const bool usual = *leftward || *options.jaw == Jaw::lower;
    return {*leftward,
            fmt::format("by the form of the arch label 1 is at the patient's {}{}", *leftward ? "right" : "left",
                        usual ? "" : ", which is unusual in an upper jaw: make sure that it is one")};
  }
  if (*options.jaw == Jaw::upper)
    return {true, "there are too few teeth to see the arch's form: label 1 is at the patient's right, as is usual"};
  throw InputError(
      "the labels are counted along the arch of a lower jaw, and its few teeth do not show which end is the patient's "
      "right: say the teeth by FDI numbers");
}

std::vector<int> arch_to_fdi(const std::vector<int>& raw, LabelNumbers numbers, const ArchPlaces& places, Jaw jaw) {
  const int length = arch_length(numbers);
  std::vector<int> fdi;
  fdi.reserve(raw.size());
  for (const int number : raw)
    fdi.push_back(number == 0 ? 0
                              : fdi_of_arch_place(places.first_is_right ? number : length + 1 - number, length, jaw));
  return fdi;
}

/// What to say where the source's jaw is not that of the teeth.
std::string doubt_about_jaw(const std::vector<int>& fdi, std::optional<Jaw> stated) {
  if (!stated || std::any_of(fdi.begin(), fdi.end(), [&](int n) { return n != 0 && jaw_of_fdi(n) == *stated; }))
    return "";
  return fmt::format(", though the jaw is said to be the {} one", jaw_name(*stated));
}

int universal_of_fdi(int fdi) {
  const int quadrant = fdi / 10, place = fdi % 10;
  switch (quadrant) {
    case 1:
      return 9 - place;
    case 2:
      return 8 + place;
    case 3:
      return 25 - place;
    default:
      return 24 + place;
  }
}

int arch_place_of_fdi(int fdi, int length) {
  const bool right = is_right_side(fdi);
  return right ? length / 2 + 1 - fdi % 10 : length / 2 + fdi % 10;
}

}  // namespace

LabelNumbers read_label_numbers(std::string_view word) {
  for (const LabelNumbers numbers : all_numbers)
    if (word == label_numbers_name(numbers)) return numbers;
  std::string plain(word);
  for (char& c : plain)
    if ((c >= 0 && c < ' ') || c == '\x7f') c = '?';
  throw UsageError(fmt::format("'{:.30}' is no numbering of labels: fdi, universal, arch14 or arch16", plain));
}

const char* label_numbers_name(LabelNumbers numbers) {
  return std::array{"fdi", "universal", "arch14", "arch16"}[static_cast<std::size_t>(numbers)];
}

Jaw jaw_of_fdi(int fdi) {
  if (!is_fdi_number(fdi)) throw UsageError(fmt::format("{} is not the FDI number of a tooth", fdi));
  return (fdi / 10 - 1) % 4 < 2 ? Jaw::upper : Jaw::lower;
}

std::optional<int> fdi_of_universal(int number) {
  if (number < 1 || number > 32) return std::nullopt;
  const int place = (number - 1) % 16 + 1;  // along the arch, from the right in the upper jaw, from the left below
  if (number <= 16) return fdi_of_arch_place(place, 16, Jaw::upper);
  return fdi_of_arch_place(17 - place, 16, Jaw::lower);
}

int fdi_of_arch_place(int place, int length, Jaw jaw) {
  if ((length != 14 && length != 16) || place < 1 || place > length)
    throw UsageError(fmt::format("{} is no place along an arch of {} teeth", place, length));
  const int half = length / 2;
  const bool right = place <= half;
  const int quadrant = jaw == Jaw::upper ? (right ? 1 : 2) : (right ? 4 : 3);
  return 10 * quadrant + (right ? half + 1 - place : place - half);
}

ScanLabels decide_label_numbers(const TriangleMesh& mesh, const std::vector<int>& raw,
                                const LabelNumberOptions& options) {
  if (raw.size() != mesh.vertices.size())
    throw UsageError(fmt::format("{} labels are given for {} vertices", raw.size(), mesh.vertices.size()));
  const Occurrences found(mesh, raw);
  if (!found.any([](int number) { return number != 0; }))
    throw InputError("no tooth is labelled: all labels are 0, which is gum");
  const Decision decision = decide(found, options);
  require_known(found, decision.numbers, raw);
  if (!found.any([&](int number) { return !is_gum(decision.numbers, number); }))
    throw InputError("no tooth is labelled: all labels are 0 or 33, which is gum among Universal numbers");
  ScanLabels labels;
  labels.numbers = decision.numbers;
  labels.decided = fmt::format("The labels are {}: {}", long_name(decision.numbers), decision.reason);
  if (decision.numbers == LabelNumbers::fdi) {
    labels.fdi = raw;
  } else if (decision.numbers == LabelNumbers::universal) {
    for (const int number : raw) labels.fdi.push_back(fdi_of_universal(number).value_or(0));
  } else {
    if (!options.jaw)
      throw InputError(
          fmt::format("the labels are {} ({}), which do not tell the jaw: say it with --jaw upper or "
                      "--jaw lower",
                      long_name(decision.numbers), decision.reason));
    const ArchPlaces places = places_along_arch(mesh, raw, options);
    labels.fdi = arch_to_fdi(raw, decision.numbers, places, *options.jaw);
    labels.decided += "; " + places.reason;
  }
  labels.decided += doubt_about_jaw(labels.fdi, options.jaw) + ".";
  return labels;
}

std::vector<int> numbered_as(const std::vector<int>& fdi, LabelNumbers numbers) {
  if (numbers == LabelNumbers::fdi) return fdi;
  const bool along = numbers != LabelNumbers::universal;
  std::map<int, int> known{{0, along ? 0 : universal_gum}};
  std::string unknown;
  std::optional<Jaw> jaw;
  std::vector<int> result;
  result.reserve(fdi.size());
  for (const int tooth : fdi) {
    auto place = known.find(tooth);
    if (place == known.end()) {
      const Jaw of_tooth = jaw_of_fdi(tooth);
      if (along && jaw && *jaw != of_tooth)
        throw InputError("the labels are of both jaws, and numbers along the arch count one: write each jaw alone");
      jaw = of_tooth;
      const bool fits = is_permanent_tooth(tooth) && (numbers != LabelNumbers::arch14 || tooth % 10 < 8);
      if (!fits) unknown += fmt::format("{}{}", unknown.empty() ? "" : ", ", tooth);
      const int number = !fits ? 0 : along ? arch_place_of_fdi(tooth, arch_length(numbers)) : universal_of_fdi(tooth);
      place = known.emplace(tooth, number).first;
    }
    result.push_back(place->second);
  }
  if (!unknown.empty())
    throw InputError(fmt::format("among {} there is none for {}: write FDI numbers", long_name(numbers), unknown));
  return result;
}

}  // namespace rhizodont
