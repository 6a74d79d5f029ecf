// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/tooth_labels.hpp"
#include "rhizodont/io.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

// The labels of a scan as they come: numbers per vertex whose meaning is not decided yet (teeth/label_numbers.hpp).
namespace rhizodont {

/// One whole number per vertex of the mesh.
struct RawLabels {
  std::vector<int> per_vertex;
  std::string origin;             ///< where they are from, to end a sentence with: "the point array Universal_ID"
  std::optional<Jaw> stated_jaw;  ///< what the source says of the jaw
  /// What the source's name or format says of the numbers: a Teeth3DS file holds FDI numbers, an array Universal_ID
  /// universal ones. Only a hint.
  std::optional<LabelNumbers> stated_numbers;
};

/// Labels from a Teeth3DS / 3DTeethSeg22 file (`labels`, one per vertex of the scan's file in its order; `jaw`).
/// `instances` may be there or not and is not needed; `id_patient` and all else is neither kept nor quoted. A vertex
/// of the mesh that several of the file were merged to takes what most of them say, of equal ones the first.
/// For STL, whose files number no vertices, as many labels as the mesh has vertices are taken in their order (first
/// appearance), and three per triangle as its corners.
/// Throws InputError, a sentence each, for text that is no JSON, a list, an empty file, no `labels` or none in them,
/// entries that are no whole numbers of 0 or more, a `jaw` that is none, and another number of labels than vertices
/// (both are said).
RawLabels labels_from_teeth3ds(std::string_view json, const MeshFile& scan);

/// Labels from an array of the file, per point or per cell. The name is the user's, in any case, with "point:" or
/// "cell:" in front where both have it; empty: the one array named as labels are in the programs that write them
/// (Label, Universal_ID, PredictedID, MaterialIds, GroupIds, fdi, scalar, tooth...) that holds whole numbers.
/// Values of cells go to vertices by the most triangles around; of equally many, those of the larger area, then the
/// lower number; vertices without triangles are gum (0).
/// Throws InputError, naming the arrays, if there is none or more than one, or one holds other than whole numbers.
RawLabels labels_from_array(const MeshFile& scan, const std::string& name = {});

/// Whether a scan has arrays that `labels_from_array` would take by their usual names.
bool has_label_array(const MeshFile& scan);

/// A colour and the number that it stands for.
struct PaletteEntry {
  std::array<std::uint8_t, 3> colour{};  ///< red, green, blue
  int number = 0;
};

/// A palette from text, "RRGGBB number" per line (also "#RRGGBB number"; empty lines and others that begin with # are
/// passed over), or JSON, {"RRGGBB": number, ...} or [["RRGGBB", number], ...]. Throws InputError, with the line, for
/// anything else, for a colour with two numbers and for no entry at all.
std::vector<PaletteEntry> read_palette(std::string_view text);

struct ColourLabelOptions {
  /// [0, 1): largest share of the coloured triangles (vertices) that may have a colour without entry, such as blended
  /// ones along borders: they take the number of their nearest neighbours.
  double unknown_share = 0.05;
};

/// Labels from the colours of triangles or vertices; where both have colours, from those of which the palette knows
/// more, else the triangles'. Triangles' numbers go to vertices as those of cells in `labels_from_array`.
/// Throws InputError for a scan without colours, and, with the commonest unknown colours, where too many are unknown.
RawLabels labels_from_colours(const MeshFile& scan, const std::vector<PaletteEntry>& palette,
                              const ColourLabelOptions& options = {});

/// One number per vertex from one per triangle, as `labels_from_array` does. Precondition: valid indices, sizes agree.
std::vector<int> vertex_labels_from_triangles(const TriangleMesh& mesh, const std::vector<int>& per_triangle);

/// One number per triangle: that of two of its corners; of three different ones the lowest that is not `gum`.
/// Precondition: valid indices, sizes agree.
std::vector<int> triangle_labels_from_vertices(const TriangleMesh& mesh, const std::vector<int>& per_vertex,
                                               int gum = 0);

}  // namespace rhizodont
