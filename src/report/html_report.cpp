// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/html_report.hpp"

#include "base/asset.hpp"
#include "base/lower_case.hpp"
#include "report/view_mesh.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/hash.hpp"
#include "rhizodont/report_page.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <openssl/evp.h>

#include <stdexcept>
#include <string_view>
#include <vector>

namespace rhizodont {

const std::vector<Asset>& report_assets();  // written by CMake

namespace {

constexpr std::string_view place_of_data = "<!--data-->";

std::string base64(const std::string& bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  const int size =
      EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                      reinterpret_cast<const unsigned char*>(bytes.data()), static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(size));
  return text;
}

/// Text that may stand in a script's element: no end of it, no comment begins in it.
std::string in_script(const std::string& json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      safe += "\\u003c";  // in JSON it is only found within strings
    } else {
      safe += c;
    }
  }
  return safe;
}

}  // namespace

std::map<std::string, std::string> report_views(const CompletedTooth& tooth, const MeshFile& crown) {
  const Point middle = middle_of(crown.mesh);
  return {{"tooth", tooth_view(tooth, {}, middle)}, {"crown", crown_view(crown.mesh, tooth, middle)}};
}

std::map<std::string, std::string> report_views(const ScanInput& input, const CompletedArch& arch) {
  std::map<std::string, std::string> views;
  const Point middle = middle_of(input.file.mesh);
  double unit = 1;
  for (const ToothOfArch& tooth : arch.teeth)
    if (tooth.tooth) unit = tooth.tooth->record.millimetres_per_unit;
  for (const ToothOfArch& tooth : arch.teeth) {
    const std::string crown = fmt::format("crown-{}", tooth.fdi);
    if (tooth.tooth) {
      views[fmt::format("tooth-{}", tooth.fdi)] = tooth_view(*tooth.tooth, tooth.clearance, middle);
      views[crown] = crown_view(tooth.crown, *tooth.tooth, middle);
    } else {
      views[crown] = plain_view(tooth.crown, middle, unit);
    }
  }
  if (!arch.gum.triangles.empty()) views["gum"] = plain_view(arch.gum, middle, unit);
  return views;
}

std::map<std::string, std::string> hashes_of(const std::vector<std::filesystem::path>& files) {
  std::map<std::string, std::string> hashes;
  for (const std::filesystem::path& file : files)
    hashes[file.filename().string()] = sha256_of_bytes(read_file_bytes(file));
  return hashes;
}

bool is_page_name(const std::filesystem::path& name) {
  const std::string ending = lower_case(name.extension().string());
  return ending == ".html" || ending == ".htm";
}

bool has_report_pages() { return !report_assets().empty(); }

void require_report_page() {
  if (!has_report_pages())
    throw UsageError(
        "This program was built without its pages, for npm or its packages could not be reached: there are reports in "
        "JSON alone.");
}

std::string html_report(const std::string& report, const ReportPage& page) {
  require_report_page();
  const std::string_view frame = report_assets().front().bytes;
  const std::size_t place = frame.find(place_of_data);
  if (place == std::string_view::npos) throw std::logic_error("the page of a report has no place for its data");
  std::string html(frame.substr(0, place));
  html += "<script type=\"application/json\" id=\"rhizodont-report\">{\"report\": " + in_script(report) +
          ", \"models\": " + in_script(nlohmann::ordered_json(page.models).dump());
  if (!page.plot.empty()) html += ", \"plot\": \"" + base64(page.plot) + "\"";
  html += ", \"views\": {";
  const char* between = "";
  for (const auto& [name, bytes] : page.views) {
    html += between + ("\"" + name) + "\": \"" + base64(bytes) + "\"";
    between = ", ";
  }
  html += "}}</script>";
  html += frame.substr(place + place_of_data.size());
  return html;
}

}  // namespace rhizodont
