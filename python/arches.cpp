// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "arrays.hpp"

#include "rhizodont/arch.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/json.hpp"
#include "rhizodont/report_page.hpp"
#include "rhizodont/segment.hpp"

#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <map>
#include <optional>
#include <set>
#include <string>

namespace rhizodont::python {
namespace {

using LabelArray = py::array_t<int, py::array::c_style | py::array::forcecast>;
using Progress = std::function<void(int, int, int)>;

py::dict found_tooth(const FoundTooth& tooth) {
  py::dict found;
  found["fdi"] = tooth.fdi;
  found["confidence"] = tooth.confidence;
  found["second"] = tooth.second;
  found["second_confidence"] = tooth.second_confidence;
  found["middle"] = py::make_tuple(tooth.middle.x(), tooth.middle.y(), tooth.middle.z());
  found["vertices"] = tooth.vertices;
  return found;
}

py::dict segment(const VertexArray& vertices, const TriangleArray& triangles, const SegmentModels& models,
                 double millimetres_per_unit, const std::optional<std::string>& jaw, const std::set<int>& missing,
                 const std::map<int, std::array<double, 3>>& teeth, int threads) {
  const TriangleMesh scan = mesh_of(vertices, triangles);
  SegmentOptions options;
  options.millimetres_per_unit = millimetres_per_unit;
  if (jaw && *jaw != "upper" && *jaw != "lower") throw UsageError("A jaw is \"upper\" or \"lower\".");
  if (jaw) options.jaw = *jaw == "upper" ? Jaw::upper : Jaw::lower;
  options.missing = missing;
  for (const auto& [fdi, place] : teeth) options.teeth[fdi] = Point(place[0], place[1], place[2]);
  options.threads = threads;
  SegmentedScan found;
  {
    const py::gil_scoped_release release;
    found = segment_scan(scan, models, options);
  }
  py::list all;
  for (const FoundTooth& tooth : found.teeth) all.append(found_tooth(tooth));
  py::dict result;
  result["labels"] = array_of<int>(std::move(found.fdi));
  result["teeth"] = all;
  result["jaw"] = found.jaw == Jaw::upper ? "upper" : "lower";
  result["jaw_confidence"] = found.jaw_confidence;
  result["jaw_reason"] = found.jaw_reason;
  result["notes"] = found.notes;
  return result;
}

py::dict clearance_of(const ToothClearance& pair) {
  py::dict result;
  result["first"] = pair.first;
  result["second"] = pair.second;
  result["crown_crown"] = pair.crown_crown;
  result["root_root"] = pair.root_root;
  result["root_crown"] = pair.root_crown;
  result["crown_root"] = pair.crown_root;
  return result;
}

/// An arch with what it was made of, as Python keeps it: its arrays are views of this memory.
struct KeptArch {
  CompletedArch arch;
  LabelledScan scan;
  ArchOptions options;
};

py::list teeth_of(const py::object& self) {
  auto& kept = self.cast<KeptArch&>();
  py::list teeth;
  for (ToothOfArch& tooth : kept.arch.teeth) {
    py::dict one;
    one["fdi"] = tooth.fdi;
    one["crown"] = views_of(tooth.crown, self);
    one["scan_vertices"] = view_of<int>(tooth.scan_vertices, 1, self);
    one["clearance"] = view_of<double>(tooth.clearance, 1, self);
    one["refusal"] = tooth.refusal;
    one["tooth"] = tooth.tooth ? py::cast(&*tooth.tooth, py::return_value_policy::reference_internal, self)
                               : py::object(py::none());
    teeth.append(one);
  }
  return teeth;
}

/// @param tooth  options of every tooth as JSON
KeptArch arch(const VertexArray& vertices, const TriangleArray& triangles, const LabelArray& labels,
              const CompletionModels& models, const std::string& tooth, const std::map<int, double>& root_lengths,
              bool resolve_collisions, double clearance_mm, const Progress& progress) {
  KeptArch kept;
  kept.scan.mesh = mesh_of(vertices, triangles);
  if (labels.ndim() != 1) throw InputError("Labels must be an array of one number per vertex.");
  kept.scan.fdi.assign(labels.data(), labels.data() + labels.size());
  kept.options.tooth = options_from_json(tooth);
  kept.options.root_lengths = root_lengths;
  kept.options.resolve_collisions = resolve_collisions;
  kept.options.clearance_mm = clearance_mm;
  const ArchProgress callback = [&progress](int done, int teeth, int fdi) {
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (progress) progress(done, teeth, fdi);
  };
  const py::gil_scoped_release release;
  kept.arch = complete_arch(kept.scan, models, kept.options, callback);
  return kept;
}

std::string page_of_arch(const KeptArch& kept) {
  const py::gil_scoped_release release;
  return arch_page(kept.arch, kept.scan, kept.options);
}

}  // namespace

void bind_arches(py::module_& module) {
  py::class_<SegmentModels>(module, "SegmentModels")
      .def_static(
          "load", [](const std::filesystem::path& folder) { return SegmentModels::load(folder); }, py::arg("folder"),
          py::call_guard<py::gil_scoped_release>());
  py::class_<KeptArch>(module, "CompletedArch")
      .def_property_readonly("teeth", &teeth_of)
      .def_property_readonly("clearances",
                             [](const KeptArch& kept) {
                               py::list all;
                               for (const ToothClearance& pair : kept.arch.clearances) all.append(clearance_of(pair));
                               return all;
                             })
      .def_property_readonly(
          "gum", [](const py::object& self) { return views_of(self.cast<const KeptArch&>().arch.gum, self); })
      .def_property_readonly("notes", [](const KeptArch& kept) { return kept.arch.notes; })
      .def("page", &page_of_arch);
  module.def("arch_tooth_options", [] { return options_to_json(ArchOptions::skirt_and_repair()); });
  module.def("arch", &arch, py::arg("vertices"), py::arg("triangles"), py::arg("labels"), py::arg("models"),
             py::arg("tooth"), py::arg("root_lengths"), py::arg("resolve_collisions"), py::arg("clearance_mm"),
             py::arg("progress"));
  module.def("segment", &segment, py::arg("vertices"), py::arg("triangles"), py::arg("models"),
             py::arg("millimetres_per_unit"), py::arg("jaw"), py::arg("missing"), py::arg("teeth"), py::arg("threads"));
}

}  // namespace rhizodont::python
