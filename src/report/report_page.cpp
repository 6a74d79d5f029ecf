// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "rhizodont/report_page.hpp"

#include "report/arch_files.hpp"
#include "report/html_report.hpp"
#include "rhizodont/report.hpp"

namespace rhizodont {

std::string tooth_page(const CompletedTooth& tooth, const TriangleMesh& crown) {
  require_report_page();
  MeshFile file;
  file.mesh = crown;
  return html_report(completion_report(tooth, {}), {report_views(tooth, file), "", {}});
}

std::string arch_page(const CompletedArch& arch, const LabelledScan& scan, const ArchOptions& options) {
  require_report_page();
  ScanInput input;
  input.file.mesh = scan.mesh;
  input.scan = scan;
  return html_report(arch_report(input, arch, options, {}), {report_views(input, arch), "", {}});
}

}  // namespace rhizodont
