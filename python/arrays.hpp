// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/mesh.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace rhizodont::python {

namespace py = pybind11;

using VertexArray = py::array_t<double, py::array::c_style | py::array::forcecast>;
using TriangleArray = py::array_t<std::int32_t, py::array::c_style | py::array::forcecast>;

/// An array over the memory of the vector, which it keeps alive: nothing is copied.
template <class Number, class Element>
py::array_t<Number> array_of(std::vector<Element> values) {
  static_assert(sizeof(Element) % sizeof(Number) == 0);
  constexpr auto width = static_cast<py::ssize_t>(sizeof(Element) / sizeof(Number));
  auto owned = std::make_unique<std::vector<Element>>(std::move(values));
  const auto rows = static_cast<py::ssize_t>(owned->size());
  // Eigen's vectors and std::array are their numbers, one after the other.
  auto* const first = reinterpret_cast<Number*>(owned->data());
  const py::capsule keeper(owned.release(), [](void* all) { delete static_cast<std::vector<Element>*>(all); });
  if constexpr (width == 1) return py::array_t<Number>(std::vector<py::ssize_t>{rows}, first, keeper);
  return py::array_t<Number>(std::vector<py::ssize_t>{rows, width}, first, keeper);
}

/// A read-only array over memory that belongs to `owner`.
template <class Number, class Element>
py::array view_of(const std::vector<Element>& values, py::ssize_t width, const py::object& owner) {
  const auto rows = static_cast<py::ssize_t>(values.size());
  std::vector<py::ssize_t> shape{rows};
  if (width > 1) shape.push_back(width);
  py::array_t<Number> view(shape, reinterpret_cast<const Number*>(values.data()), owner);
  view.attr("flags").attr("writeable") = false;
  return view;
}

/// (vertices, triangles) of a mesh that belongs to `owner`, read-only.
inline py::tuple views_of(const TriangleMesh& mesh, const py::object& owner) {
  return py::make_tuple(view_of<double>(mesh.vertices, 3, owner), view_of<std::int32_t>(mesh.triangles, 3, owner));
}

/// A mesh of two arrays, n x 3 and m x 3. Throws InputError for arrays of another shape.
TriangleMesh mesh_of(const VertexArray& vertices, const TriangleArray& triangles);

/// (vertices, triangles) as arrays.
inline py::tuple arrays_of(TriangleMesh mesh) {
  return py::make_tuple(array_of<double>(std::move(mesh.vertices)), array_of<std::int32_t>(std::move(mesh.triangles)));
}

void bind_teeth(py::module_& module);
void bind_arches(py::module_& module);

}  // namespace rhizodont::python
