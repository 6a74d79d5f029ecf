// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/recognise.hpp"

#include "base/lower_case.hpp"
#include "io/cursors.hpp"
#include "io/stl.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rhizodont {
namespace {

constexpr const char* formats_read = "STL, PLY, OBJ, OFF, VTP or VTK";

/// What a file is that is not read, and so what to do.
enum class Kind { no_mesh, archive, other_mesh };

struct Signature {
  std::size_t place;
  std::string_view bytes;
  const char* name;  // with its article
  Kind kind;
};

using namespace std::string_view_literals;
constexpr Signature signatures[]{
    {0, "\x89PNG"sv, "a PNG picture", Kind::no_mesh},
    {0, "\xff\xd8\xff"sv, "a JPEG picture", Kind::no_mesh},
    {0, "GIF8"sv, "a GIF picture", Kind::no_mesh},
    {0, "II*\0"sv, "a TIFF picture", Kind::no_mesh},
    {0, "MM\0*"sv, "a TIFF picture", Kind::no_mesh},
    {0, "RIFF"sv, "a RIFF file (picture, sound or film)", Kind::no_mesh},
    {4, "ftyp"sv, "a film or picture (MP4, HEIC)", Kind::no_mesh},
    {0, "%PDF"sv, "a PDF document", Kind::no_mesh},
    {0, "%!PS"sv, "a PostScript document", Kind::no_mesh},
    {0, "{\\rtf"sv, "an RTF document", Kind::no_mesh},
    {0, "\xd0\xcf\x11\xe0"sv, "an Office document", Kind::no_mesh},
    {128, "DICM"sv, "a DICOM file (X-ray or volume)", Kind::no_mesh},
    {344, "n+1\0"sv, "a NIfTI volume", Kind::no_mesh},
    {0, "NRRD"sv, "an NRRD volume", Kind::no_mesh},
    {0, "ObjectType ="sv, "a MetaImage volume", Kind::no_mesh},
    {0, "SQLite format 3"sv, "an SQLite database", Kind::no_mesh},
    {0,
     "\x7f"
     "ELF"sv,
     "a program", Kind::no_mesh},
    {0, "MZ"sv, "a Windows program", Kind::no_mesh},
    {0, "\0\x05\x16\x07"sv, "a side file of macOS (its name begins with '._'; the mesh is beside it)", Kind::no_mesh},
    {0, "version https://git-lfs"sv, "a pointer of Git LFS (the file itself was not fetched)", Kind::no_mesh},
    {0, "\x93NUMPY"sv, "a NumPy array", Kind::no_mesh},
    {0, "\x89HDF"sv, "an HDF5 file", Kind::no_mesh},
    {0, "PK\x05\x06"sv, "an empty ZIP archive", Kind::no_mesh},
    {0, "7z\xbc\xaf\x27\x1c"sv, "a 7z archive", Kind::archive},
    {0, "Rar!"sv, "a RAR archive", Kind::archive},
    {0, "BZh"sv, "a file packed with bzip2", Kind::archive},
    {0,
     "\xfd"
     "7zXZ\0"sv,
     "a file packed with xz", Kind::archive},
    {0, "\x28\xb5\x2f\xfd"sv, "a file packed with zstd", Kind::archive},
    {0, "\x04\x22\x4d\x18"sv, "a file packed with lz4", Kind::archive},
    {257, "ustar"sv, "a TAR archive", Kind::archive},
    {0, "glTF"sv, "a glTF scene (GLB)", Kind::other_mesh},
    {0, "ISO-10303-21"sv, "a STEP model", Kind::other_mesh},
    {0, "Kaydara FBX"sv, "an FBX scene", Kind::other_mesh},
    {0, "; FBX"sv, "an FBX scene", Kind::other_mesh},
    {0, "BLENDER"sv, "a Blender file", Kind::other_mesh},
    {0, "3D Geometry File Format"sv, "a Rhino model (3DM)", Kind::other_mesh},
    {0, "#VRML"sv, "a VRML scene", Kind::other_mesh},
    {0, "#Inventor"sv, "an Open Inventor scene", Kind::other_mesh},
    {0, "#X3D"sv, "an X3D scene", Kind::other_mesh},
    {0, "#USDA"sv, "a USD scene", Kind::other_mesh},
    {0, "PXR-USDC"sv, "a USD scene", Kind::other_mesh},
    {0, "OCTM"sv, "an OpenCTM mesh", Kind::other_mesh},
    {0, "DRACO"sv, "a Draco mesh", Kind::other_mesh},
    {0, "xof 0"sv, "a DirectX mesh (X)", Kind::other_mesh},
    {0, "U3D\0"sv, "a U3D scene", Kind::other_mesh},
    {0, "AC10"sv, "an AutoCAD drawing (DWG)", Kind::other_mesh},
    {0, "# .PCD"sv, "a point cloud (PCD)", Kind::other_mesh},
};

/// Root elements of XML files.
constexpr Signature roots[]{
    {0, "html", "a web page (HTML)", Kind::no_mesh},
    {0, "svg", "an SVG picture", Kind::no_mesh},
    {0, "hps", "a 3Shape scan (DCM)", Kind::other_mesh},
    {0, "collada", "a COLLADA scene", Kind::other_mesh},
    {0, "x3d", "an X3D scene", Kind::other_mesh},
    {0, "amf", "an AMF model", Kind::other_mesh},
    {0, "model", "the model part of a 3MF file", Kind::other_mesh},
};

[[noreturn]] void refuse(const char* name, Kind kind) {
  if (kind == Kind::archive) throw InputError(fmt::format("this is {}: unpack it first", name));
  if (kind == Kind::no_mesh) throw InputError(fmt::format("this is {}, not a mesh", name));
  throw InputError(fmt::format("this is {}, which is not read: save it as STL, PLY or OBJ", name));
}

void refuse_zip(std::string_view bytes) {
  if (!bytes.starts_with("PK\x03\x04")) return;
  const std::string_view start = bytes.substr(0, 65536),
                         end = bytes.substr(bytes.size() - std::min<std::size_t>(bytes.size(), 65536));
  for (const std::string_view part : {start, end}) {
    if (part.find("3D/3dmodel.model") != std::string_view::npos) refuse("a 3MF model", Kind::other_mesh);
    if (part.find("word/document.xml") != std::string_view::npos ||
        part.find("xl/workbook.xml") != std::string_view::npos)
      refuse("an Office document", Kind::no_mesh);
  }
  refuse("a ZIP archive", Kind::archive);
}

void refuse_known_others(std::string_view bytes) {
  if (bytes.find_first_not_of('\0') == std::string_view::npos)
    throw InputError("the file holds nothing but zeros: it was not copied or saved whole");
  if (bytes.find_first_not_of(" \t\r\n\v\f") == std::string_view::npos)
    throw InputError("the file holds nothing but blanks");
  refuse_zip(bytes);
  for (const Signature& s : signatures)
    if (bytes.size() > s.place && bytes.substr(s.place).starts_with(s.bytes)) refuse(s.name, s.kind);
  if (bytes.size() < 6) return;
  // two letters and the file's size
  ByteCursor cursor(bytes, std::endian::little);
  cursor.skip(2);
  if (cursor.read<std::uint32_t>() != bytes.size()) return;
  if (bytes.starts_with("BM")) refuse("a BMP picture", Kind::no_mesh);
  if (bytes.starts_with("MM")) refuse("a 3DS scene", Kind::other_mesh);
}

/// The first element of an XML text in lower case, without the prefix of its name space; empty if there is none.
std::string root_element(std::string_view text) {
  for (std::size_t place = text.find('<'); place != std::string_view::npos; place = text.find('<', place + 1)) {
    const std::string_view rest = text.substr(place + 1);
    if (rest.starts_with("!--")) {
      place = text.find("-->", place);
      if (place == std::string_view::npos) break;
      continue;
    }
    if (lower_case(rest.substr(0, 13)) == "!doctype html") return "html";
    if (rest.starts_with('!') || rest.starts_with('?')) continue;
    const std::string_view name = rest.substr(0, rest.find_first_of(" \t\r\n/>"));
    const std::size_t colon = name.find(':');
    return lower_case(name.substr(colon == std::string_view::npos ? 0 : colon + 1));
  }
  return {};
}

MeshFormat recognise_xml(std::string_view bytes, std::string_view ending) {
  const std::string root = root_element(bytes.substr(0, 65536));
  if (root == "vtkfile") return MeshFormat::vtp;
  for (const Signature& s : roots)
    if (root == s.bytes) refuse(s.name, s.kind);
  // pages that lack their beginning
  for (const char* name : {"head", "body", "title", "meta", "script", "div", "center", "h1"})
    if (root == name) refuse("a web page (HTML)", Kind::no_mesh);
  if (ending == ".vtp") return MeshFormat::vtp;
  throw InputError("this is an XML file, but none with a mesh that is read (VTP)");
}

/// The first lines of a text that hold anything but a comment.
class ContentLines {
 public:
  explicit ContentLines(std::string_view text) : cursor_(text) {}
  std::optional<std::string_view> next() {
    while (cursor_.remaining() > 0) {
      std::string_view line = cursor_.rest_of_line();
      line = line.substr(0, line.find('#'));
      if (line.find_first_not_of(" \t\v\f") != std::string_view::npos) return line;
    }
    return std::nullopt;
  }

 private:
  TextCursor cursor_;
};

template <class Number>
std::size_t leading_numbers(std::string_view line, std::vector<Number>& numbers) {
  numbers.clear();
  TextCursor words(line);
  while (const auto word = words.word()) {
    const auto number = parse_number<Number>(*word);
    if (!number) break;
    numbers.push_back(*number);
  }
  return numbers.size();
}

bool has_off_header(std::string_view text) {
  ContentLines lines(text.substr(0, 65536));
  std::string word = lower_case(TextCursor(lines.next().value_or("")).word().value_or(""));
  while (!word.empty() && word.back() >= '0' && word.back() <= '9') word.pop_back();
  for (const char* prefix : {"st", "c", "n", "4", "n"})
    if (word != "off" && word.starts_with(prefix)) word.erase(0, std::string_view(prefix).size());
  return word == "off";
}

/// An OFF file without its first word: counts, and then as many lines as they say.
bool is_headerless_off(std::string_view text) {
  ContentLines lines(text);
  std::vector<std::int64_t> counts;
  std::vector<double> numbers;
  const std::size_t found = leading_numbers(lines.next().value_or(""), counts);
  if (found < 2 || found > 3 || counts[0] < 3 || counts[1] < 1) return false;
  const auto length = static_cast<std::int64_t>(text.size());
  if (counts[0] > length || counts[1] > length) return false;
  for (std::int64_t v = 0; v < counts[0]; ++v)
    if (leading_numbers(lines.next().value_or(""), numbers) < 3) return false;
  std::vector<std::int64_t> face;
  for (std::int64_t f = 0; f < counts[1]; ++f)
    if (leading_numbers(lines.next().value_or(""), face) < 2 || face[0] < 0) return false;
  return true;
}

bool is_obj(std::string_view text, bool named_so) {
  ContentLines lines(text);
  std::vector<double> numbers;
  while (const auto line = lines.next()) {
    TextCursor words(*line);
    const std::string_view keyword = words.word().value_or("");
    if (keyword == "v" && leading_numbers(words.rest_of_line(), numbers) >= (named_so ? 0U : 3U)) return true;
    if (named_so && (keyword == "f" || keyword == "vn" || keyword == "vt" || keyword == "o" || keyword == "g" ||
                     keyword == "mtllib" || keyword == "usemtl"))
      return true;
  }
  return false;
}

/// A text of numbers only, in lines of three or more.
bool is_point_list(std::string_view text) {
  ContentLines lines(text.substr(0, 4096));
  std::vector<double> numbers;
  for (int k = 0; k < 3; ++k)
    if (leading_numbers(lines.next().value_or(""), numbers) < 3) return false;
  return true;
}

void refuse_known_texts(std::string_view text, std::string_view ending) {
  const std::size_t start = text.find_first_not_of(" \t\r\n");
  if (text[start] == '{' || text[start] == '[') {
    if (text.substr(0, 65536).find("\"asset\"") != std::string_view::npos) refuse("a glTF scene", Kind::other_mesh);
    refuse("a JSON file", Kind::no_mesh);
  }
  TextCursor words(text);
  if (words.word() == "0" && words.word() == "SECTION") refuse("a DXF drawing", Kind::other_mesh);
  if (text.size() > 80 && text[72] == 'S' && text.substr(73, 7).find_first_not_of(" 01") == std::string_view::npos)
    refuse("an IGES model", Kind::other_mesh);
  if (ContentLines(text).next().value_or("").starts_with("newmtl"))
    refuse("a list of materials (MTL) that goes with an OBJ file", Kind::no_mesh);
  if (ending != ".off" && is_point_list(text))
    throw InputError("the file holds numbers only, such as points, and no triangles");
}

/// For what the content does not tell: the reader of the file's name says what is amiss.
MeshFormat by_ending(std::string_view bytes, std::string_view ending) {
  if (ending == ".ply") return MeshFormat::ply;
  if (ending == ".vtp") return MeshFormat::vtp;
  if (ending == ".off" && is_text(bytes)) return MeshFormat::off;
  if (ending == ".stl" && !is_text(bytes)) return MeshFormat::stl;
  if (ending == ".stl") throw InputError("this is a text, but no STL file: it does not begin with 'solid' and 'facet'");
  if (ending == ".obj" && is_text(bytes))
    throw InputError("the file holds no vertices and no triangles, so it is no OBJ file");
  throw InputError(fmt::format("this is no mesh in a format that is read ({})", formats_read));
}

}  // namespace

bool is_text(std::string_view bytes) {
  std::size_t control = 0;
  const std::string_view start = bytes.substr(0, 4096);
  for (const char c : start) {
    if (c == '\0') return false;
    control += static_cast<unsigned char>(c) < 32 && !(c >= '\t' && c <= '\r');
  }
  return control * 100 <= start.size();
}

MeshFormat recognise(std::string_view bytes, std::string_view ending) {
  if (is_exact_binary_stl(bytes)) return MeshFormat::stl;
  refuse_known_others(bytes);
  if (bytes.starts_with("ply") && bytes.size() > 3 && " \t\r\n"sv.find(bytes[3]) != std::string_view::npos)
    return MeshFormat::ply;
  if (lower_case(bytes.substr(0, 18)) == "# vtk datafile ver") return MeshFormat::vtk;
  // raw data may follow after these beginnings
  if (bytes[bytes.find_first_not_of(" \t\r\n\v\f")] == '<' && is_text(bytes.substr(0, 64)))
    return recognise_xml(bytes, ending);
  if (has_off_header(bytes)) return MeshFormat::off;
  if (!is_text(bytes)) return is_binary_stl_of_other_size(bytes) ? MeshFormat::stl : by_ending(bytes, ending);
  if (is_stl_text(bytes)) return MeshFormat::stl;
  if (is_obj(bytes, ending == ".obj")) return MeshFormat::obj;
  if (is_headerless_off(bytes)) return MeshFormat::off;
  refuse_known_texts(bytes, ending);
  return by_ending(bytes, ending);
}

}  // namespace rhizodont
