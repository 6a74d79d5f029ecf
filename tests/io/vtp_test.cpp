// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/base64.hpp"
#include "io/io_test_tools.hpp"
#include "io/vtp_arrays.hpp"

#include <fmt/core.h>
#include <lz4.h>
#include <zlib.h>

namespace rhizodont {
namespace {

using test::Bytes, test::expect_refused, test::load_bytes;

std::string encode_base64(const std::string& bytes) {
  static const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? letters[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

enum class Storage { ascii, inline_base64, appended_raw, appended_base64 };

struct Layout {
  Storage storage = Storage::ascii;
  VtkCompression compression = VtkCompression::none;
  bool wide_header = false;
  std::endian order = std::endian::little;
  std::size_t block = 32;  // bytes per compressed block
};

// Writes the arrays of a small square in any of VTK's layouts.
class VtpWriter {
 public:
  explicit VtpWriter(Layout layout) : layout_(layout) {}

  std::string write() {
    const std::string points =
        array<float>("Float32", "NumberOfComponents=\"3\" Name=\"Points\"", {0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0.1F});
    const std::string heights = array<double>("Float64", "Name=\"height\"", {0.1, 0.2, 0.3, 0.4});
    const std::string normals =
        array<float>("Float32", "NumberOfComponents=\"3\" Name=\"Normals\"", std::vector<float>(12, 0.5F));
    const std::string connectivity = array<std::int64_t>("Int64", "Name=\"connectivity\"", {0, 1, 2, 3, 2, 1, 0});
    const std::string offsets = array<std::int32_t>("Int32", "Name=\"offsets\"", {4, 7});
    std::string text =
        fmt::format("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"{}\"{}{}>\n",
                    layout_.order == std::endian::big ? "BigEndian" : "LittleEndian",
                    layout_.wide_header ? " header_type=\"UInt64\"" : "", compressor());
    text += "<PolyData><Piece NumberOfPoints=\"4\" NumberOfPolys=\"2\">\n<PointData>" + heights + normals +
            "</PointData>\n<Points>" + points + "</Points>\n<Polys>" + connectivity + offsets +
            "</Polys></Piece></PolyData>\n";
    if (layout_.storage == Storage::appended_raw)
      text += "<AppendedData encoding=\"raw\">\n _" + appended_ + "\n</AppendedData>\n";
    if (layout_.storage == Storage::appended_base64)
      text += "<AppendedData encoding=\"base64\">_" + appended_ + "</AppendedData>\n";
    return text + "</VTKFile>\n";
  }

 private:
  void add_size(Bytes& bytes, std::size_t size) const {
    layout_.wide_header ? bytes.add(static_cast<std::uint64_t>(size)) : bytes.add(static_cast<std::uint32_t>(size));
  }

  const char* compressor() const {
    if (layout_.compression == VtkCompression::none) return "";
    return layout_.compression == VtkCompression::lz4 ? " compressor=\"vtkLZ4DataCompressor\""
                                                      : " compressor=\"vtkZLibDataCompressor\"";
  }

  std::string squeeze(const std::string& block) const {
    std::string squeezed(2 * block.size() + 64, '\0');
    if (layout_.compression == VtkCompression::lz4) {
      squeezed.resize(static_cast<std::size_t>(LZ4_compress_default(
          block.data(), squeezed.data(), static_cast<int>(block.size()), static_cast<int>(squeezed.size()))));
      return squeezed;
    }
    uLongf size = squeezed.size();
    compress(reinterpret_cast<Bytef*>(squeezed.data()), &size, reinterpret_cast<const Bytef*>(block.data()),
             block.size());
    squeezed.resize(size);
    return squeezed;
  }

  // The sizes in front, and the data.
  std::pair<std::string, std::string> pack(const std::string& data) const {
    Bytes sizes({}, layout_.order);
    if (layout_.compression == VtkCompression::none) {
      add_size(sizes, data.size());
      return {sizes.str(), data};
    }
    const std::size_t count = (data.size() + layout_.block - 1) / layout_.block;
    add_size(sizes, count);
    add_size(sizes, layout_.block);
    add_size(sizes, data.size() % layout_.block);
    std::string packed;
    for (std::size_t k = 0; k < count; ++k) {
      const std::string block = data.substr(k * layout_.block, layout_.block);
      const std::string squeezed = squeeze(block);
      add_size(sizes, squeezed.size());
      packed += squeezed;
    }
    return {sizes.str(), packed};
  }

  template <class T>
  std::string array(const std::string& type, const std::string& names, const std::vector<T>& values) {
    const std::string head = "<DataArray type=\"" + type + "\" " + names;
    std::string text;
    for (const T value : values) text += fmt::format("{} ", value);
    if (layout_.storage == Storage::ascii) return head + " format=\"ascii\">" + text + "</DataArray>";
    Bytes data({}, layout_.order);
    for (const T value : values) data.add(value);
    const auto [sizes, packed] = pack(data.str());
    if (layout_.storage == Storage::inline_base64)
      return head + " format=\"binary\">\n  " + encode_base64(sizes) + encode_base64(packed) + "\n</DataArray>";
    const std::size_t offset = appended_.size();
    appended_ +=
        layout_.storage == Storage::appended_raw ? sizes + packed : encode_base64(sizes) + encode_base64(packed);
    return head + fmt::format(" format=\"appended\" offset=\"{}\"/>", offset);
  }

  Layout layout_;
  std::string appended_;
};

std::vector<Layout> all_layouts() {
  std::vector<Layout> layouts{{}};
  for (const Storage storage : {Storage::inline_base64, Storage::appended_raw, Storage::appended_base64})
    for (const VtkCompression compression : {VtkCompression::none, VtkCompression::zlib, VtkCompression::lz4})
      for (const bool wide : {false, true})
        for (const std::endian order : {std::endian::little, std::endian::big})
          for (const std::size_t block : {std::size_t{16}, std::size_t{32}, std::size_t{4096}})
            if (compression != VtkCompression::none || block == 32)
              layouts.push_back({storage, compression, wide, order, block});
  return layouts;
}

TEST(Vtp, EveryLayoutIsTheSameMesh) {
  for (const Layout& layout : all_layouts()) {
    const MeshFile file = load_bytes("a.vtp", VtpWriter(layout).write());
    EXPECT_EQ(file.mesh.vertices, (std::vector<Point>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.1F}}));
    EXPECT_EQ(file.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {2, 1, 0}}));
    ASSERT_EQ(file.vertex_attributes.size(), 1U);
    EXPECT_EQ(file.vertex_attributes.at("height").values, (std::vector<double>{0.1, 0.2, 0.3, 0.4}));
    EXPECT_TRUE(file.coordinates_fit_float);
  }
}

TEST(Vtp, TruncatedFilesAreRefused) {
  for (const Storage storage :
       {Storage::ascii, Storage::inline_base64, Storage::appended_raw, Storage::appended_base64}) {
    const std::string whole =
        VtpWriter({storage, storage == Storage::ascii ? VtkCompression::none : VtkCompression::zlib}).write();
    for (std::size_t size = 0; size + 12 < whole.size(); ++size)
      EXPECT_THROW(test::parse(read_vtp, whole.substr(0, size)), InputError) << size;
  }
}

std::string changed_vtp(const std::string& what, const std::string& by, Layout layout = {}) {
  std::string text = VtpWriter(layout).write();
  return text.replace(text.find(what), what.size(), by);
}

TEST(Vtp, DamagedDataAreRefused) {
  Layout raw{Storage::appended_raw, VtkCompression::zlib, false, std::endian::little, 4096};
  std::string text = VtpWriter(raw).write();
  const std::size_t data = text.find(" _") + 2;
  text[data + 16 + 5] = static_cast<char>(text[data + 16 + 5] ^ 0x55);
  expect_refused("a.vtp", text, "is damaged");
  // the block of the first array is said to be 2 thousand million bytes long
  text = VtpWriter(raw).write();
  text.replace(data + 4, 4, "\xff\xff\xff\x7f");
  text.replace(data + 8, 4, std::string(4, '\0'));
  expect_refused("a.vtp", text, "is damaged");
  text = VtpWriter(raw).write();
  text.replace(data, 4, "\xff\xff\xff\xff");
  expect_refused("a.vtp", text, "is cut off");
  raw.compression = VtkCompression::none;
  text = VtpWriter(raw).write();
  text.replace(text.find(" _") + 2, 4, "\xff\xff\xff\xff");
  expect_refused("a.vtp", text, "is cut off");
  expect_refused("a.vtp", changed_vtp("offset=\"0\"", "offset=\"99999999999\"", raw), "begins after the end");
}

TEST(Vtp, BadContentsAreRefused) {
  expect_refused("a.vtp", "", "empty");
  expect_refused("a.vtp", "<a><b></a>", "line 1: the file is no proper XML");
  expect_refused("a.vtp", changed_vtp("type=\"PolyData\"", "type=\"ImageData\""), "PolyData");
  expect_refused("a.vtp", changed_vtp("byte_order", "compressor=\"vtkLZMADataCompressor\" byte_order"),
                 "vtkLZMADataCompressor");
  expect_refused("a.vtp", changed_vtp("NumberOfPoints=\"4\"", "NumberOfPoints=\"5\""),
                 "announces 5 points and holds 4");
  expect_refused("a.vtp", changed_vtp("0 1 2 3 2 1 0", "0 1 2 4 2 1 0"),
                 "polygon 0 (counted from 0) refers to vertex 4");
  expect_refused("a.vtp", changed_vtp("0 1 2 3 2 1 0", "0 1 2 3 2 -1 0"),
                 "polygon 1 (counted from 0) refers to vertex -1");
  expect_refused("a.vtp", changed_vtp("4 7", "4 8"), "polygon 1 (counted from 0) lies outside");
  expect_refused("a.vtp", changed_vtp("4 7", "4 2"), "polygon 1 (counted from 0) lies outside");
  expect_refused("a.vtp", changed_vtp("4 7", ""), "no triangles");
  expect_refused("a.vtp", changed_vtp("0 0 0 1 0 0", "0 0 nan 1 0 0"), "not finite");
  expect_refused("a.vtp", changed_vtp("0 0 0 1 0 0", "0 0 no 1 0 0"), "'Points' holds 'no'");
  expect_refused("a.vtp",
                 changed_vtp("type=\"Float32\" NumberOfComponents=\"3\" Name=\"Points\"",
                             "type=\"Bit\" NumberOfComponents=\"3\" Name=\"Points\""),
                 "'Points' is of type 'Bit'");
}

TEST(Vtp, PackingIsKnownByTheBlocksThemselves) {
  for (const VtkCompression compression : {VtkCompression::zlib, VtkCompression::lz4}) {
    const bool zlib = compression == VtkCompression::zlib;
    const MeshFile file = load_bytes("a.vtp", changed_vtp(zlib ? "vtkZLib" : "vtkLZ4", zlib ? "vtkLZ4" : "vtkZLib",
                                                          {Storage::appended_raw, compression}));
    EXPECT_EQ(file.mesh.triangles.size(), 3U);
  }
}

TEST(Vtp, DamagedLz4IsRefused) {
  const Layout layout{Storage::appended_raw, VtkCompression::lz4, false, std::endian::little, 4096};
  std::string text = VtpWriter(layout).write();
  const std::size_t data = text.find(" _") + 2;
  text[data + 16] = static_cast<char>(text[data + 16] ^ 0x7f);
  expect_refused("a.vtp", text, "is damaged");
}

TEST(Vtp, ArraysThatAllNameTheSameBytesAreNotUnpackedWithoutEnd) {
  constexpr std::uint32_t size = 1 << 20;
  std::string arrays;
  for (int k = 0; k < 200; ++k)
    arrays += fmt::format(R"(<DataArray type="UInt8" Name="a{}" format="appended" offset="0"/>)", k);
  const std::string text =
      R"(<VTKFile type="PolyData"><PolyData><Piece NumberOfPoints="3"><PointData>)" + arrays +
      R"(</PointData><Points><DataArray type="Float32" NumberOfComponents="3">0 0 0 1 0 0 0 1 0)"
      R"(</DataArray></Points><Polys><DataArray type="Int32" Name="connectivity">0 1 2</DataArray>)"
      R"(<DataArray type="Int32" Name="offsets">3</DataArray></Polys></Piece></PolyData>)"
      R"(<AppendedData encoding="raw">_)" +
      test::Bytes().add(size).str() + std::string(size, '\0') + "</AppendedData></VTKFile>";
  const MeshFile file = load_bytes("a.vtp", text);
  EXPECT_EQ(file.mesh.triangles.size(), 1U);
  ASSERT_EQ(file.notes.size(), 200U);
  EXPECT_NE(file.notes.front().find("has 1048576 values for 3 points"), std::string::npos) << file.notes.front();
  EXPECT_NE(file.notes.back().find("far more than a mesh of its size"), std::string::npos) << file.notes.back();
}

TEST(Vtp, ValuesThatDoNotFitAreNoted) {
  const MeshFile good = load_bytes("a.vtp", VtpWriter({}).write());
  for (const auto& [what, by, note] : std::vector<std::array<std::string, 3>>{
           {"0.1 0.2 0.3 0.4", "0.1 0.2 0.3", "'height' has 3 values for 4 points"},
           {"0.1 0.2 0.3 0.4", "0.1 0.2 0.3 0.4 0.5", "'height' has 5 values for 4 points"},
           {"0.1 0.2 0.3 0.4", "0.1 0.2 0.3 many", "'height' holds 'many'"},
           {"type=\"Float64\" Name=\"height\"", "type=\"Bit\" Name=\"height\"", "'height' is of type 'Bit'"}}) {
    const MeshFile file = load_bytes("a.vtp", changed_vtp(what, by));
    EXPECT_TRUE(test::same_bits(file.mesh, good.mesh));
    EXPECT_TRUE(file.vertex_attributes.empty());
    EXPECT_TRUE(test::notes_hold(file, note)) << note;
  }
}

TEST(Vtp, PiecesAreJoinedAndColoursRead) {
  const std::string points =
      "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0 1 0 0 0 1 0</DataArray></Points>";
  const std::string polys =
      "<Polys><DataArray type=\"UInt8\" Name=\"connectivity\">0 1 2</DataArray><DataArray type=\"UInt64\" "
      "Name=\"offsets\">3</DataArray></Polys>";
  const std::string colours =
      "<PointData><DataArray type=\"UInt8\" Name=\"RGB\" NumberOfComponents=\"3\">255 0 1 4 5 6 7 8 "
      "9</DataArray></PointData>";
  const std::string piece = "<Piece NumberOfPoints=\"3\">" + points + polys + colours + "</Piece>";
  const auto whole = [](const std::string& pieces) {
    return "<VTKFile type=\"PolyData\"><PolyData>" + pieces + "</PolyData></VTKFile>";
  };
  const MeshFile one = load_bytes("a.vtp", whole(piece));
  EXPECT_EQ(one.vertex_attributes.at("red").values, (std::vector<double>{255, 4, 7}));
  EXPECT_EQ(one.vertex_attributes.at("blue").values, (std::vector<double>{1, 6, 9}));
  std::string shifted = piece;
  shifted.replace(shifted.find("0 0 0 1 0 0 0 1 0"), 17, "0 0 5 1 0 5 0 1 5");
  const MeshFile two = load_bytes("a.vtp", whole(piece + shifted));
  EXPECT_EQ(two.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 4, 5}}));
  EXPECT_EQ(two.mesh.vertices[4], Point(1, 0, 5));
}

TEST(Vtp, StripsAreTurnedEverySecondTime) {
  const std::string text =
      "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"5\"><Points><DataArray type=\"Float64\" "
      "NumberOfComponents=\"3\">"
      "0 0 0 0 1 0 1 0 0 1 1 0 2 0 0</DataArray></Points><Strips><DataArray type=\"Int32\" Name=\"connectivity\">0 1 2 "
      "3 4</DataArray>"
      "<DataArray type=\"Int32\" Name=\"offsets\">5</DataArray></Strips></Piece></PolyData></VTKFile>";
  EXPECT_EQ(load_bytes("a.vtp", text).mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}}));
}

TEST(Base64, KnownValuesAndJoinedPieces) {
  EXPECT_EQ(decode_base64("Zm9vYmFy"), "foobar");
  EXPECT_EQ(decode_base64("Zm9vYg=="), "foob");
  EXPECT_EQ(decode_base64(" Zm9v\nYmE=\t"), "fooba");
  EXPECT_EQ(decode_base64("Zg==Zm8=Zm9v"), "ffofoo");
  EXPECT_EQ(decode_base64(""), "");
  EXPECT_EQ(decode_base64("Zm9v<"), "foo");
}

}  // namespace
}  // namespace rhizodont
