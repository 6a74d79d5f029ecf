// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "arrays.hpp"

#include "rhizodont/arch.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/json.hpp"
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

/// A tooth as Python takes it over: its arrays move, nothing is copied.
py::dict taken_tooth(ToothOfArch& tooth) {
  py::dict result;
  result["fdi"] = tooth.fdi;
  result["crown"] = arrays_of(std::move(tooth.crown));
  result["scan_vertices"] = array_of<int>(std::move(tooth.scan_vertices));
  result["clearance"] = array_of<double>(std::move(tooth.clearance));
  result["refusal"] = tooth.refusal;
  result["tooth"] = tooth.tooth ? py::cast(*std::move(tooth.tooth)) : py::object(py::none());
  return result;
}

/// @param tooth  options of every tooth as JSON
py::dict arch(const VertexArray& vertices, const TriangleArray& triangles, const LabelArray& labels,
              const CompletionModels& models, const std::string& tooth, const std::map<int, double>& root_lengths,
              bool resolve_collisions, double clearance_mm, const Progress& progress) {
  LabelledScan scan{mesh_of(vertices, triangles), {}};
  if (labels.ndim() != 1) throw InputError("Labels must be an array of one number per vertex.");
  scan.fdi.assign(labels.data(), labels.data() + labels.size());
  ArchOptions options;
  options.tooth = options_from_json(tooth);
  options.root_lengths = root_lengths;
  options.resolve_collisions = resolve_collisions;
  options.clearance_mm = clearance_mm;
  const ArchProgress callback = [&progress](int done, int teeth, int fdi) {
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (progress) progress(done, teeth, fdi);
  };
  CompletedArch done;
  {
    const py::gil_scoped_release release;
    done = complete_arch(scan, models, options, callback);
  }
  py::list teeth, clearances;
  for (ToothOfArch& one : done.teeth) teeth.append(taken_tooth(one));
  for (const ToothClearance& pair : done.clearances) clearances.append(clearance_of(pair));
  py::dict result;
  result["teeth"] = teeth;
  result["clearances"] = clearances;
  result["gum"] = arrays_of(std::move(done.gum));
  result["notes"] = done.notes;
  return result;
}

}  // namespace

void bind_arches(py::module_& module) {
  py::class_<SegmentModels>(module, "SegmentModels")
      .def_static(
          "load", [](const std::filesystem::path& folder) { return SegmentModels::load(folder); }, py::arg("folder"),
          py::call_guard<py::gil_scoped_release>());
  module.def("arch_tooth_options", [] { return options_to_json(ArchOptions::skirt_and_repair()); });
  module.def("arch", &arch, py::arg("vertices"), py::arg("triangles"), py::arg("labels"), py::arg("models"),
             py::arg("tooth"), py::arg("root_lengths"), py::arg("resolve_collisions"), py::arg("clearance_mm"),
             py::arg("progress"));
  module.def("segment", &segment, py::arg("vertices"), py::arg("triangles"), py::arg("models"),
             py::arg("millimetres_per_unit"), py::arg("jaw"), py::arg("missing"), py::arg("teeth"), py::arg("threads"));
}

}  // namespace rhizodont::python
