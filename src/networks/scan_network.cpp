// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "networks/scan_network.hpp"

#include "networks/elementwise.hpp"
#include "networks/layers.hpp"
#include "networks/safetensors.hpp"
#include "networks/weight_reader.hpp"
#include "rhizodont/error.hpp"

#include <cmath>
#include <optional>

namespace rhizodont {
namespace {

using namespace networks;

/// x + MLP(edges(norm(x))).
struct EdgeBlock {
  Norm norm;
  EdgeConvolution edges;
  Mlp mlp;
};

struct AttentionBlock {
  Norm first, second;
  Attention attention;
  Mlp mlp;
};

/// One level on the way down and up again.
struct LevelLayers {
  std::optional<EdgeConvolution> down;  // from the finer level
  std::vector<EdgeBlock> blocks;
  Linear from_above, from_side;  // on the way up; not of the coarsest level
  std::optional<EdgeBlock> last;
};

EdgeBlock edge_block(const WeightReader& reader, Eigen::Index width) {
  return {reader.norm("norm", width), reader.edge_convolution("edges", width + 6, width, true),
          reader.mlp("mlp", {width, 2 * width, width})};
}

Matrix view_of(const std::vector<float>& values, Eigen::Index columns) {
  return Eigen::Map<const Matrix>(values.data(), static_cast<Eigen::Index>(values.size()) / columns, columns);
}

/// Position over the level's unit, and normal.
Matrix geometry_of(const ScanLevel& level, float unit) {
  Matrix geometry(static_cast<Eigen::Index>(level.size()), 6);
  geometry << view_of(level.positions, 3) / unit, view_of(level.normals, 3);
  return geometry;
}

Matrix beside(const Matrix& left, const Matrix& right) {
  Matrix both(left.rows(), left.cols() + right.cols());
  both << left, right;
  return both;
}

Matrix chosen_rows(const Matrix& values, const std::vector<std::int32_t>& chosen) {
  Matrix result(static_cast<Eigen::Index>(chosen.size()), values.cols());
  for (std::size_t i = 0; i < chosen.size(); ++i) result.row(static_cast<Eigen::Index>(i)) = values.row(chosen[i]);
  return result;
}

Matrix applied(const EdgeBlock& block, const Matrix& x, const Matrix& geometry,
               const std::vector<std::int32_t>& neighbours) {
  const Matrix known = beside(normalised(block.norm, x), geometry);
  return x + multilayer(block.mlp, edge_convolution(block.edges, known, known, neighbours));
}

Matrix applied(const AttentionBlock& block, Matrix x) {
  const Matrix known = normalised(block.first, x);
  x += attention(block.attention, known, known);
  return x + multilayer(block.mlp, normalised(block.second, x));
}

Matrix spread(const Matrix& coarse, const ScanLevel& fine) {
  Matrix result = Matrix::Zero(static_cast<Eigen::Index>(fine.size()), coarse.cols());
  for (std::size_t i = 0; i < fine.size(); ++i)
    for (std::size_t j = 3 * i; j < 3 * i + 3; ++j)
      result.row(static_cast<Eigen::Index>(i)) += fine.above_weights[j] * coarse.row(fine.above[j]);
  return result;
}

}  // namespace

struct ScanNetwork::Impl {
  explicit Impl(const TensorFile& file);
  Matrix features(const ScanPyramid& scan, Matrix& coarsest) const;

  ScanShape shape;
  std::map<std::string, std::string> metadata;
  Linear first;
  std::array<LevelLayers, ScanShape::levels> levels;
  std::vector<AttentionBlock> attention;
  Norm head_norm;
  Mlp head, summary;
};

ScanNetwork::Impl::Impl(const TensorFile& file) : shape(read_scan_shape(file.metadata)), metadata(file.metadata) {
  const WeightReader reader(file);
  first = reader.linear("first", scan_feature_count, shape.widths[0]);
  for (std::size_t l = 0; l < ScanShape::levels; ++l) {
    const WeightReader of_level = reader.within("level_" + std::to_string(l));
    const Eigen::Index width = shape.widths[l];
    if (l > 0) {
      const Eigen::Index finer = shape.widths[l - 1];
      levels[l].down = of_level.edge_convolution("down", finer + 6, width, true);
    }
    for (int b = 0; b < shape.blocks[l]; ++b)
      levels[l].blocks.push_back(edge_block(of_level.within("block_" + std::to_string(b)), width));
    if (l + 1 == ScanShape::levels) continue;
    levels[l].from_above = of_level.linear("from_above", shape.widths[l + 1], width, false);
    levels[l].from_side = of_level.linear("from_side", width, width);
    levels[l].last = edge_block(of_level.within("last"), width);
  }
  const Eigen::Index width = shape.widths.back();
  for (int b = 0; b < 2; ++b) {
    const WeightReader of_block = reader.within("attention_" + std::to_string(b));
    attention.push_back({of_block.norm("first", width), of_block.norm("second", width),
                         of_block.attention("attention", width, shape.heads),
                         of_block.mlp("mlp", {width, 2 * width, width})});
  }
  head_norm = reader.norm("head_norm", shape.widths[0]);
  head = reader.mlp("head", {shape.widths[0], 2 * shape.widths[0], scan_output_count});
  summary = reader.mlp("summary", {width, width, scan_summary_count});
}

Matrix ScanNetwork::Impl::features(const ScanPyramid& scan, Matrix& coarsest) const {
  std::array<Matrix, ScanShape::levels> geometry, x;
  for (std::size_t l = 0; l < ScanShape::levels; ++l) {
    const ScanLevel& level = scan.levels[l];
    geometry[l] = geometry_of(level, scan_edge_unit(shape, l));
    if (l == 0) {
      x[l] = linear(first, view_of(scan.features, scan_feature_count));
    } else {
      // The finer level's geometry in this level's unit.
      const Matrix fine = geometry_of(scan.levels[l - 1], scan_edge_unit(shape, l));
      const Matrix keys = beside(x[l - 1], fine);
      x[l] = edge_convolution(*levels[l].down, keys, chosen_rows(keys, level.from), level.below);
    }
    for (const EdgeBlock& block : levels[l].blocks) x[l] = applied(block, x[l], geometry[l], level.neighbours);
  }
  for (const AttentionBlock& block : attention) x.back() = applied(block, std::move(x.back()));
  coarsest = x.back();
  for (std::size_t l = ScanShape::levels - 1; l-- > 0;) {
    x[l] = linear(levels[l].from_side, x[l]) + spread(linear(levels[l].from_above, x[l + 1]), scan.levels[l]);
    x[l] = applied(*levels[l].last, x[l], geometry[l], scan.levels[l].neighbours);
  }
  return x[0];
}

ScanNetwork::ScanNetwork(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
ScanNetwork::ScanNetwork(ScanNetwork&&) noexcept = default;
ScanNetwork& ScanNetwork::operator=(ScanNetwork&&) noexcept = default;
ScanNetwork::~ScanNetwork() = default;

ScanNetwork ScanNetwork::load(const std::filesystem::path& path) {
  return ScanNetwork(std::make_unique<Impl>(read_safetensors(path)));
}

ScanReading ScanNetwork::read(const ScanPyramid& scan) const {
  Matrix coarsest;
  const Matrix x = impl_->features(scan, coarsest);
  const Matrix each = multilayer(impl_->head, normalised(impl_->head_norm, x));
  const Matrix mean = coarsest.colwise().mean();
  const Matrix whole = multilayer(impl_->summary, mean);
  if (!each.allFinite() || !whole.allFinite())
    throw NoResultError("The network that finds teeth came to no result for this scan.");
  ScanReading reading;
  Matrix kinds = each.leftCols(scan_kind_count);
  softmax_rows(kinds);
  reading.kinds.assign(kinds.data(), kinds.data() + kinds.size());
  const Matrix offsets = scan_offset_mm * each.middleCols(scan_kind_count, 3);
  reading.offsets.assign(offsets.data(), offsets.data() + offsets.size());
  for (Eigen::Index i = 0; i < each.rows(); ++i)
    reading.borders.push_back(1 / (1 + std::exp(-each(i, scan_kind_count + 3))));
  reading.upper = 1 / (1 + std::exp(-whole(0, 0)));
  for (Eigen::Index a = 0; a < 3; ++a) {
    reading.front[static_cast<std::size_t>(a)] = whole(0, 1 + a);
    reading.occlusal[static_cast<std::size_t>(a)] = whole(0, 4 + a);
  }
  return reading;
}

const ScanShape& ScanNetwork::shape() const { return impl_->shape; }

const std::map<std::string, std::string>& ScanNetwork::metadata() const { return impl_->metadata; }

}  // namespace rhizodont
