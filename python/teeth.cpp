// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

#include "arrays.hpp"

#include "rhizodont/complete.hpp"
#include "rhizodont/json.hpp"
#include "rhizodont/models.hpp"
#include "rhizodont/report.hpp"
#include "rhizodont/report_page.hpp"
#include "rhizodont/tooth_file.hpp"

#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <optional>
#include <string>
#include <string_view>

namespace rhizodont::python {
namespace {

using Progress = std::function<void(std::string)>;

/// Python's callback from a thread without the interpreter's lock. What it raises ends the work; so does Ctrl-C.
ProgressCallback with_lock(const Progress& progress) {
  return [progress](std::string_view stage) {
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (progress) progress(std::string(stage));
  };
}

CompletedTooth complete(const VertexArray& vertices, const TriangleArray& triangles, const CompletionModels& models,
                        const std::string& options, const Progress& progress) {
  const TriangleMesh crown = mesh_of(vertices, triangles);
  const CompleteOptions taken = options_from_json(options);
  const ProgressCallback callback = with_lock(progress);
  const py::gil_scoped_release release;
  return complete_tooth(crown, models, taken, callback);
}

PreparedTooth prepare(const VertexArray& vertices, const TriangleArray& triangles, const CompletionModels& models,
                      const std::string& options, const Progress& progress) {
  const TriangleMesh crown = mesh_of(vertices, triangles);
  const CompleteOptions taken = options_from_json(options);
  const ProgressCallback callback = with_lock(progress);
  const py::gil_scoped_release release;
  return prepare_tooth(crown, models, taken, callback);
}

/// `options`: of which steering and transition count.
CompletedTooth finish(const PreparedTooth& prepared, const std::string& options, const Progress& progress) {
  const CompleteOptions taken = options_from_json(options);
  const ProgressCallback callback = with_lock(progress);
  const py::gil_scoped_release release;
  return finish_tooth(prepared, taken.steering, taken.transition, callback);
}

std::vector<CompletedTooth> candidates(const VertexArray& vertices, const TriangleArray& triangles,
                                       const CompletionModels& models, int count, const std::string& options,
                                       const Progress& progress) {
  const TriangleMesh crown = mesh_of(vertices, triangles);
  const CompleteOptions taken = options_from_json(options);
  const ProgressCallback callback = with_lock(progress);
  const py::gil_scoped_release release;
  return complete_candidates(crown, models, count, taken, callback);
}

/// What `check` says of a tooth of this crown, with what the record lists excused.
std::string check_tooth(const VertexArray& vertices, const TriangleArray& triangles, const CompletedTooth& tooth) {
  const TriangleMesh crown = mesh_of(vertices, triangles);
  CheckOptions options = allowing_for(tooth.record.repairs);
  for (const DroppedCrownVertex& dropped : tooth.record.crown.dropped_vertices)
    if (dropped.reason != DropReason::repair) options.dropped_vertices.push_back(dropped.vertex);
  const py::gil_scoped_release release;
  return check_to_json(check(crown, tooth.mesh, options));
}

std::string page_of_tooth(const CompletedTooth& tooth, const VertexArray& vertices, const TriangleArray& triangles) {
  const TriangleMesh crown = mesh_of(vertices, triangles);
  const py::gil_scoped_release release;
  return tooth_page(tooth, crown);
}

void save_tooth(const CompletedTooth& tooth, const std::filesystem::path& path) {
  const py::gil_scoped_release release;
  require_format_holds(tooth, path);
  save_mesh(path, tooth_file(tooth, MeshFile{}));
}

}  // namespace

void bind_teeth(py::module_& module) {
  module.def("default_models_folder", [] { return default_models_folder(); });
  py::class_<CompletionModels>(module, "CompletionModels")
      .def_static(
          "load", [](const std::filesystem::path& folder) { return CompletionModels::load(folder); }, py::arg("folder"),
          py::call_guard<py::gil_scoped_release>());

  py::class_<CompletedTooth>(module, "CompletedTooth")
      .def_property_readonly("vertices",
                             [](const py::object& self) {
                               return view_of<double>(self.cast<const CompletedTooth&>().mesh.vertices, 3, self);
                             })
      .def_property_readonly("triangles",
                             [](const py::object& self) {
                               return view_of<std::int32_t>(self.cast<const CompletedTooth&>().mesh.triangles, 3, self);
                             })
      .def_property_readonly("source",
                             [](const py::object& self) {
                               return view_of<std::uint8_t>(self.cast<const CompletedTooth&>().source, 1, self);
                             })
      .def_property_readonly("uncertainty",
                             [](const py::object& self) {
                               return view_of<double>(self.cast<const CompletedTooth&>().uncertainty, 1, self);
                             })
      .def_property_readonly("fdi", [](const CompletedTooth& tooth) { return tooth.record.fdi; })
      .def_property_readonly("root_length", [](const CompletedTooth& tooth) { return tooth.record.root.length_mm; })
      .def_property_readonly("root_interval",
                             [](const CompletedTooth& tooth) -> std::optional<std::pair<double, double>> {
                               if (!tooth.record.root.interval) return std::nullopt;
                               return std::pair(tooth.record.root.interval->length_low_mm,
                                                tooth.record.root.interval->length_high_mm);
                             })
      .def_property_readonly("kept_vertices",
                             [](const py::object& self) {
                               return view_of<std::int32_t>(
                                   self.cast<const CompletedTooth&>().record.crown.kept_vertices, 1, self);
                             })
      .def_property_readonly("warnings", [](const CompletedTooth& tooth) { return all_warnings(tooth.record); })
      .def_property_readonly("options", [](const CompletedTooth& tooth) { return options_to_json(tooth.options); })
      .def("report", [](const CompletedTooth& tooth) { return completion_report(tooth, {}); })
      .def("save", &save_tooth, py::arg("path"));

  py::class_<PreparedTooth>(module, "PreparedTooth")
      .def_property_readonly("fdi", [](const PreparedTooth& prepared) { return prepared.record().fdi; })
      .def_property_readonly("options",
                             [](const PreparedTooth& prepared) { return options_to_json(prepared.options()); });

  module.def("has_report_pages", &has_report_pages);
  module.def("tooth_page", &page_of_tooth, py::arg("tooth"), py::arg("vertices"), py::arg("triangles"));
  module.def("check_tooth", &check_tooth, py::arg("vertices"), py::arg("triangles"), py::arg("tooth"));
  module.def("complete", &complete, py::arg("vertices"), py::arg("triangles"), py::arg("models"), py::arg("options"),
             py::arg("progress"));
  module.def("prepare", &prepare, py::arg("vertices"), py::arg("triangles"), py::arg("models"), py::arg("options"),
             py::arg("progress"));
  module.def("finish", &finish, py::arg("prepared"), py::arg("options"), py::arg("progress"));
  module.def("candidates", &candidates, py::arg("vertices"), py::arg("triangles"), py::arg("models"), py::arg("count"),
             py::arg("options"), py::arg("progress"));
}

}  // namespace rhizodont::python
