// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "poisson/peers.hpp"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polyhedron_3.h>
#include <CGAL/poisson_surface_reconstruction.h>
#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <map>

#include "poisson/clouds.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using PointWithNormal = std::pair<Kernel::Point_3, Kernel::Vector_3>;

void read_bytes(std::istream& in, void* to, std::size_t count) {
  in.read(static_cast<char*>(to), static_cast<std::streamsize>(count));
}

}  // namespace

void write_samples(const std::filesystem::path& file, const OrientedPoints& samples) {
  std::ofstream out(file, std::ios::binary);
  for (std::size_t s = 0; s < samples.points.size(); ++s) {
    const std::array<double, 6> row{samples.points[s].x(),  samples.points[s].y(),  samples.points[s].z(),
                                    samples.normals[s].x(), samples.normals[s].y(), samples.normals[s].z()};
    out.write(reinterpret_cast<const char*>(row.data()), sizeof row);
  }
}

OrientedPoints read_samples(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string() + " cannot be read");
  OrientedPoints samples;
  std::array<double, 6> row{};
  while (in.read(reinterpret_cast<char*>(row.data()), sizeof row)) {
    samples.points.emplace_back(row[0], row[1], row[2]);
    samples.normals.emplace_back(row[3], row[4], row[5]);
  }
  return samples;
}

PeerResult open3d_poisson(const OrientedPoints& samples, int depth, int runs, const std::filesystem::path& scratch) {
  const auto points_file = scratch / "samples.bin", mesh_file = scratch / "mesh.bin";
  write_samples(points_file, samples);
  // Its threads wait in a loop by default: with any other work on the machine it then takes ten times as long.
  const std::string command =
      fmt::format("OMP_WAIT_POLICY=PASSIVE /usr/bin/python3 '{}' '{}' {} 2 {} '{}'", RHIZODONT_OPEN3D_SCRIPT,
                  points_file.string(), depth, runs, mesh_file.string());
  PeerResult result;
  std::FILE* pipe = popen(command.c_str(), "r");
  const bool timed = pipe && std::fscanf(pipe, "%lf", &result.seconds) == 1;
  if (!pipe || pclose(pipe) != 0 || !timed) throw NoResultError("Open3D's Poisson reconstruction failed.");
  std::ifstream in(mesh_file, std::ios::binary);
  std::array<std::int64_t, 2> counts{};
  read_bytes(in, counts.data(), sizeof counts);
  result.mesh.vertices.resize(static_cast<std::size_t>(counts[0]));
  for (Point& p : result.mesh.vertices) read_bytes(in, p.data(), 3 * sizeof(double));
  result.mesh.triangles.resize(static_cast<std::size_t>(counts[1]));
  for (Triangle& t : result.mesh.triangles) read_bytes(in, t.data(), 3 * sizeof(std::int32_t));
  return result;
}

PeerResult cgal_poisson(const OrientedPoints& samples, double spacing) {
  std::vector<PointWithNormal> points;
  for (std::size_t s = 0; s < samples.points.size(); ++s) {
    const Point& p = samples.points[s];
    const Eigen::Vector3d& n = samples.normals[s];
    points.emplace_back(Kernel::Point_3(p.x(), p.y(), p.z()), Kernel::Vector_3(n.x(), n.y(), n.z()));
  }
  CGAL::Polyhedron_3<Kernel> surface;
  PeerResult result;
  result.seconds = best_seconds(
      [&] {
        surface.clear();
        if (!CGAL::poisson_surface_reconstruction_delaunay(
                points.begin(), points.end(), CGAL::First_of_pair_property_map<PointWithNormal>(),
                CGAL::Second_of_pair_property_map<PointWithNormal>(), surface, spacing))
          throw NoResultError("CGAL's Poisson reconstruction failed.");
      },
      1);
  std::map<const void*, std::int32_t> number;
  for (auto v = surface.vertices_begin(); v != surface.vertices_end(); ++v) {
    number[&*v] = static_cast<std::int32_t>(result.mesh.vertices.size());
    result.mesh.vertices.emplace_back(v->point().x(), v->point().y(), v->point().z());
  }
  for (auto f = surface.facets_begin(); f != surface.facets_end(); ++f) {
    const auto h = f->halfedge();
    result.mesh.triangles.push_back(
        {number[&*h->vertex()], number[&*h->next()->vertex()], number[&*h->next()->next()->vertex()]});
  }
  return result;
}

}  // namespace rhizodont
