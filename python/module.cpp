// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later

// The compiled half of the Python module: arrays in, arrays out, options and figures as JSON text. Python's half,
// beside it in rhizodont/, gives them names and types.
#include "arrays.hpp"

#include "rhizodont/check.hpp"
#include "rhizodont/error.hpp"
#include "rhizodont/evaluate.hpp"
#include "rhizodont/io.hpp"
#include "rhizodont/json.hpp"
#include "rhizodont/measure.hpp"
#include "rhizodont/version.hpp"

#include <pybind11/functional.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cstring>
#include <map>
#include <string>

namespace rhizodont::python {
namespace {

const char* name_of(ElementKind kind) {
  switch (kind) {
    case ElementKind::vertices:
      return "vertices";
    case ElementKind::triangles:
      return "triangles";
    case ElementKind::vertex_pairs:
      return "vertex_pairs";
    case ElementKind::triangle_pairs:
      return "triangle_pairs";
    case ElementKind::other:
      break;
  }
  return "other";
}

/// The library's errors as Python exceptions of the same names, with `elements` and `kind`.
void bind_errors(py::module_& module) {
  // Never destroyed: errors may be translated until the interpreter ends.
  static const auto* const types = new std::map<ErrorCode, py::object>([&module] {
    const py::object base = py::module_::import("builtins").attr("RuntimeError");
    const auto exception = [&module](const char* name, const py::object& parent) {
      const std::string full = std::string("rhizodont.") + name;
      PyObject* const type = PyErr_NewException(full.c_str(), parent.ptr(), nullptr);
      if (!type) throw py::error_already_set();
      auto object = py::reinterpret_steal<py::object>(type);
      module.attr(name) = object;
      return object;
    };
    const py::object error = exception("Error", base);
    return std::map<ErrorCode, py::object>{{ErrorCode::internal, error},
                                           {ErrorCode::wrong_usage, exception("UsageError", error)},
                                           {ErrorCode::unusable_input, exception("InputError", error)},
                                           {ErrorCode::no_result, exception("NoResultError", error)},
                                           {ErrorCode::unwritable, exception("OutputError", error)}};
  }());
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const Error& error) {
      const auto found = types->find(error.code());
      const py::object& type = found != types->end() ? found->second : types->at(ErrorCode::internal);
      const py::object instance = type(error.what());
      instance.attr("elements") = error.elements();
      instance.attr("kind") = name_of(error.kind());
      PyErr_SetObject(type.ptr(), instance.ptr());
    }
  });
}

py::tuple load(const std::filesystem::path& path) {
  MeshFile file;
  {
    const py::gil_scoped_release release;
    file = load_mesh(path);
  }
  py::dict vertices, triangles;
  for (auto& [name, attribute] : file.vertex_attributes)
    vertices[py::str(name)] = array_of<double>(std::move(attribute.values));
  for (auto& [name, attribute] : file.triangle_attributes)
    triangles[py::str(name)] = array_of<double>(std::move(attribute.values));
  const py::tuple mesh = arrays_of(std::move(file.mesh));
  return py::make_tuple(mesh[0], mesh[1], vertices, triangles, file.notes);
}

void save(const std::filesystem::path& path, const VertexArray& vertices, const TriangleArray& triangles,
          const std::map<std::string, std::vector<double>>& attributes) {
  MeshFile file;
  file.mesh = mesh_of(vertices, triangles);
  for (const auto& [name, values] : attributes)
    file.vertex_attributes[name] = {name == source_attribute ? AttributeType::uint8 : AttributeType::float32, values};
  const py::gil_scoped_release release;
  save_mesh(path, file);
}

std::string check_json(const VertexArray& crown_vertices, const TriangleArray& crown_triangles,
                       const VertexArray& tooth_vertices, const TriangleArray& tooth_triangles,
                       std::vector<int> dropped_vertices) {
  const TriangleMesh crown = mesh_of(crown_vertices, crown_triangles), tooth = mesh_of(tooth_vertices, tooth_triangles);
  CheckOptions options;
  options.dropped_vertices = std::move(dropped_vertices);
  const py::gil_scoped_release release;
  return check_to_json(check(crown, tooth, options));
}

std::string measure_json(const VertexArray& vertices, const TriangleArray& triangles) {
  const TriangleMesh mesh = mesh_of(vertices, triangles);
  const py::gil_scoped_release release;
  return measures_to_json(measure(mesh));
}

/// Progress is called with Python's lock; what it raises ends the work, and so does Ctrl-C.
std::string evaluate(const std::filesystem::path& cases, const CompletionModels& models, const std::string& options,
                     const std::filesystem::path& templates,
                     const std::function<void(int, int, int, std::string)>& progress) {
  const EvaluateOptions taken{options_from_json(options), templates};
  const EvaluateProgress callback = [&progress](int fdi, int place, int all, const std::string& predictor) {
    const py::gil_scoped_acquire lock;
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (progress) progress(fdi, place, all, predictor);
  };
  const py::gil_scoped_release release;
  return evaluate_to_json(cases, models, taken, callback);
}

std::string root_figures(const VertexArray& crown_vertices, const TriangleArray& crown_triangles,
                         const VertexArray& true_vertices, const TriangleArray& true_triangles,
                         const VertexArray& predicted_vertices, const TriangleArray& predicted_triangles) {
  const TriangleMesh crown = mesh_of(crown_vertices, crown_triangles), truth = mesh_of(true_vertices, true_triangles),
                     predicted = mesh_of(predicted_vertices, predicted_triangles);
  const py::gil_scoped_release release;
  return root_figures_to_json(crown, truth, predicted);
}

}  // namespace

TriangleMesh mesh_of(const VertexArray& vertices, const TriangleArray& triangles) {
  if (vertices.ndim() != 2 || vertices.shape(1) != 3) throw InputError("Vertices must be an array of n x 3 numbers.");
  if (triangles.ndim() != 2 || triangles.shape(1) != 3)
    throw InputError("Triangles must be an array of m x 3 numbers of vertices.");
  TriangleMesh mesh;
  mesh.vertices.resize(static_cast<std::size_t>(vertices.shape(0)));
  mesh.triangles.resize(static_cast<std::size_t>(triangles.shape(0)));
  if (!mesh.vertices.empty())
    std::memcpy(mesh.vertices.data()->data(), vertices.data(), sizeof(Point) * mesh.vertices.size());
  if (!mesh.triangles.empty())
    std::memcpy(mesh.triangles.data()->data(), triangles.data(), sizeof(Triangle) * mesh.triangles.size());
  return mesh;
}

}  // namespace rhizodont::python

PYBIND11_MODULE(_core, module) {
  using namespace rhizodont::python;
  module.attr("version") = RHIZODONT_VERSION;
  bind_errors(module);
  module.def("load", &load, py::arg("path"));
  module.def("save", &save, py::arg("path"), py::arg("vertices"), py::arg("triangles"), py::arg("attributes"));
  module.def("check", &check_json, py::arg("crown_vertices"), py::arg("crown_triangles"), py::arg("tooth_vertices"),
             py::arg("tooth_triangles"), py::arg("dropped_vertices"));
  module.def("measure", &measure_json, py::arg("vertices"), py::arg("triangles"));
  bind_teeth(module);
  bind_arches(module);
  module.def("evaluate", &evaluate, py::arg("cases"), py::arg("models"), py::arg("options"), py::arg("templates"),
             py::arg("progress"));
  module.def("root_figures", &root_figures, py::arg("crown_vertices"), py::arg("crown_triangles"),
             py::arg("true_vertices"), py::arg("true_triangles"), py::arg("predicted_vertices"),
             py::arg("predicted_triangles"));
}
