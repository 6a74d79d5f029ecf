// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
// VTK XML PolyData: points, polygons, triangle strips and one-component data of points and cells.
#include "io/attribute_types.hpp"
#include "io/colours.hpp"
#include "io/cursors.hpp"
#include "io/face_list.hpp"
#include "io/formats.hpp"
#include "io/notes.hpp"
#include "io/vtp_arrays.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>

namespace rhizodont {
namespace {

constexpr std::size_t always_room = std::size_t{64} << 20, most_per_byte = 40;

struct Document {
  pugi::xml_document xml;
  VtkStorage storage;
};

// Raw appended bytes are not XML: they are cut out before the text is parsed.
std::string without_appended_data(std::string_view bytes, std::string_view& appended) {
  const std::size_t tag = bytes.find("<AppendedData");
  if (tag == std::string_view::npos) return std::string(bytes);
  const std::size_t open = bytes.find('>', tag);
  const std::size_t start = open == std::string_view::npos ? open : bytes.find('_', open);
  if (start == std::string_view::npos) throw InputError("the file is cut off: its appended data are missing");
  const std::size_t end = bytes.rfind("</AppendedData");
  if (end == std::string_view::npos || end <= start)
    throw InputError("the file is cut off: its appended data do not end");
  appended = bytes.substr(start + 1, end - start - 1);
  return std::string(bytes.substr(0, start)).append(bytes.substr(end));
}

VtkCompression compression_named(std::string_view compressor) {
  if (compressor.empty()) return VtkCompression::none;
  if (compressor == "vtkZLibDataCompressor") return VtkCompression::zlib;
  if (compressor == "vtkLZ4DataCompressor") return VtkCompression::lz4;
  throw InputError(fmt::format(
      "the file is compressed with '{:.40}', which is not read; save it with zlib or without compression", compressor));
}

void open_document(std::string_view bytes, Document& document) {
  const std::string text = without_appended_data(bytes, document.storage.appended);
  const pugi::xml_parse_result parsed = document.xml.load_buffer(text.data(), text.size());
  if (!parsed) {
    const auto line =
        1 + std::count(text.begin(),
                       text.begin() + std::min<std::ptrdiff_t>(parsed.offset, static_cast<std::ptrdiff_t>(text.size())),
                       '\n');
    throw InputError(fmt::format("line {}: the file is no proper XML ({})", line, parsed.description()), {line});
  }
  const pugi::xml_node root = document.xml.child("VTKFile");
  if (std::string_view(root.attribute("type").as_string()) != "PolyData")
    throw InputError("this is no VTK file with surface data (PolyData)");
  const std::string_view compressor = root.attribute("compressor").as_string();
  VtkStorage& storage = document.storage;
  storage.room = always_room + most_per_byte * bytes.size();
  storage.compression = compression_named(compressor);
  storage.wide_header = std::string_view(root.attribute("header_type").as_string()) == "UInt64";
  storage.byte_order = std::string_view(root.attribute("byte_order").as_string()) == "BigEndian" ? std::endian::big
                                                                                                 : std::endian::little;
  storage.appended_raw = std::string_view(root.child("AppendedData").attribute("encoding").as_string()) == "raw";
}

class PieceReader {
 public:
  PieceReader(VtkStorage& storage, MeshFile& file, FaceList& faces) : storage_(storage), file_(file), faces_(faces) {}

  void read(const pugi::xml_node& piece, bool with_attributes) {
    const std::size_t first = file_.mesh.vertices.size();
    read_points(piece);
    added_ = file_.mesh.vertices.size() - first;
    first_ = static_cast<std::int64_t>(first);
    const std::size_t first_face = faces_.face_count();
    read_cells(piece.child("Polys"), false);
    read_cells(piece.child("Strips"), true);
    added_faces_ = faces_.face_count() - first_face;
    if (with_attributes) {
      read_attributes(piece.child("PointData"), "points",
                      [&](const std::string& name, VtkArray array) { take_of_points(name, std::move(array)); });
      // cells are numbered through all kinds in this order
      cells_before_ =
          named_array(piece.child("Verts"), "offsets").size() + named_array(piece.child("Lines"), "offsets").size();
      read_attributes(piece.child("CellData"), "cells",
                      [&](const std::string& name, VtkArray array) { take_of_cells(name, std::move(array)); });
    }
  }

 private:
  void read_points(const pugi::xml_node& piece) {
    const VtkArray points = read_vtk_array(piece.child("Points").child("DataArray"), storage_);
    const std::uint64_t announced = piece.attribute("NumberOfPoints").as_ullong();
    if (points.components != 3 || points.values.size() % 3 != 0)
      throw InputError("the file's points have no three coordinates");
    if (points.values.size() / 3 != announced)
      throw InputError(fmt::format("the file announces {} points and holds {}", announced, points.values.size() / 3));
    for (std::size_t k = 0; k < points.values.size(); k += 3)
      file_.mesh.vertices.emplace_back(points.values[k], points.values[k + 1], points.values[k + 2]);
  }

  std::vector<double> named_array(const pugi::xml_node& cells, const char* name) const {
    const pugi::xml_node node = cells.find_child_by_attribute("DataArray", "Name", name);
    return node ? read_vtk_array(node, storage_).values : std::vector<double>{};
  }

  void read_cells(const pugi::xml_node& cells, bool strips) {
    const std::vector<double> connectivity = named_array(cells, "connectivity"),
                              offsets = named_array(cells, "offsets");
    std::size_t begin = 0;
    std::vector<std::int32_t> corners;
    for (std::size_t cell = 0; cell < offsets.size(); ++cell) {
      const double end = offsets[cell];
      if (!(end >= static_cast<double>(begin)) || end > static_cast<double>(connectivity.size()))
        throw InputError(fmt::format("polygon {} (counted from 0) lies outside the file's list of corners", cell),
                         {static_cast<std::int64_t>(cell)});
      corners.clear();
      for (; begin < static_cast<std::size_t>(end); ++begin) {
        const double v = connectivity[begin];
        if (!(v >= 0 && v < static_cast<double>(added_)))
          throw InputError(
              fmt::format("polygon {} (counted from 0) refers to vertex {}, which does not exist", cell, v),
              {static_cast<std::int64_t>(cell)});
        corners.push_back(to_index(first_ + static_cast<std::int64_t>(v)));
      }
      strips ? faces_.add_strip(corners) : faces_.add_polygon(corners);
    }
  }

  static bool is_colour(const pugi::xml_node& node) {
    const int components = node.attribute("NumberOfComponents").as_int(1);
    return (components == 3 || components == 4) && std::string_view(node.attribute("type").as_string()) == "UInt8";
  }

  // Values beside the mesh are no reason to refuse it.
  template <class Take>
  void read_attributes(const pugi::xml_node& data, const char* of_what, const Take& take) {
    for (const pugi::xml_node& node : data.children("DataArray")) {
      const std::string name = node.attribute("Name").as_string();
      const int components = node.attribute("NumberOfComponents").as_int(1);
      const bool is_text = std::string_view(node.attribute("type").as_string()) == "String";
      if (name.empty() || is_text || (components != 1 && !is_colour(node))) continue;
      try {
        take(name, read_vtk_array(node, storage_));
      } catch (const InputError& error) {
        file_.notes.push_back(fmt::format("Values of the {} were passed over: {}.", of_what, error.what()));
      }
    }
  }

  static void require_size(const std::string& name, const VtkArray& array, std::size_t count, const char* of_what) {
    if (array.values.size() != count * array.components)
      throw InputError(
          fmt::format("the array '{:.60}' has {} values for {} {}", name, array.values.size(), count, of_what));
  }

  void take_of_cells(const std::string& name, VtkArray array) {
    require_size(name, array, cells_before_ + added_faces_, "cells");
    array.values.erase(array.values.begin(),
                       array.values.begin() + static_cast<std::ptrdiff_t>(cells_before_ * array.components));
    if (array.components == 1) {
      file_.triangle_attributes[name] = {array.type, faces_.of_triangles(array.values)};
      return;
    }
    put_face_colours(file_, faces_, colours_of(array.values, array.components));
  }

  void take_of_points(const std::string& name, VtkArray array) {
    require_size(name, array, added_, "points");
    if (array.components == 1)
      file_.vertex_attributes[name] = {array.type, std::move(array.values)};
    else
      add_colours(file_, colours_of(array.values, array.components));
  }

  VtkStorage& storage_;
  MeshFile& file_;
  FaceList& faces_;
  std::size_t added_ = 0, added_faces_ = 0, cells_before_ = 0;
  std::int64_t first_ = 0;
};

}  // namespace

MeshFile read_vtp(std::string_view bytes) {
  Document document;
  open_document(bytes, document);
  const auto pieces = document.xml.child("VTKFile").child("PolyData").children("Piece");
  const bool one_piece = std::distance(pieces.begin(), pieces.end()) == 1;
  MeshFile file;
  FaceList faces;
  PieceReader reader(document.storage, file, faces);
  for (const pugi::xml_node& piece : pieces)
    if (piece.attribute("NumberOfPoints").as_ullong() > 0) reader.read(piece, one_piece);
  faces.move_to(file);
  return file;
}

}  // namespace rhizodont
