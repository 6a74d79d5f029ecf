// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
//
// Convolutions that wrap around: B. Shi et al., "DeepPano", 2015. Batch normalisation (S. Ioffe, C. Szegedy, 2015) is
// part of the weights here. Residual connection: K. He et al., 2016.
#include "completion/panorama_features.hpp"

#include "rhizodont/error.hpp"

#include <algorithm>
#include <array>

namespace rhizodont {
namespace {

/// Channels (rows) of a map whose places (columns) lie row by row.
struct Map {
  Eigen::MatrixXf values;
  Eigen::Index rows = 1, columns = 1;
};

/// Each output place's inputs as a column. Columns of the map wrap around, beyond its rows there is nothing.
Map neighbourhoods(const Map& map, Eigen::Index kernel_rows, Eigen::Index kernel_columns, Eigen::Index stride) {
  const Eigen::Index channels = map.values.rows(), kernel = kernel_rows * kernel_columns;
  Map result{Eigen::MatrixXf::Zero(channels * kernel, (map.rows / stride) * (map.columns / stride)), map.rows / stride,
             map.columns / stride};
  if (map.rows == 1) result = {Eigen::MatrixXf::Zero(channels * kernel, map.columns), 1, map.columns};
  for (Eigen::Index r = 0; r < result.rows; ++r)
    for (Eigen::Index c = 0; c < result.columns; ++c)
      for (Eigen::Index i = 0; i < kernel_rows; ++i) {
        const Eigen::Index row = r * stride + i - kernel_rows / 2;
        if (row < 0 || row >= map.rows) continue;
        for (Eigen::Index j = 0; j < kernel_columns; ++j) {
          const Eigen::Index column = (c * stride + j - kernel_columns / 2 + map.columns) % map.columns;
          for (Eigen::Index k = 0; k < channels; ++k)
            result.values(k * kernel + i * kernel_columns + j, r * result.columns + c) =
                map.values(k, row * map.columns + column);
        }
      }
  return result;
}

Map convolved(const Map& map, const PanoramaLayer& layer, Eigen::Index stride) {
  Map result = neighbourhoods(map, layer.kernel_rows, layer.kernel_columns, stride);
  result.values = ((layer.weight * result.values).colwise() + layer.bias).cwiseMax(0.0F);
  return result;
}

/// Strides of the convolutions over rows and columns.
constexpr std::array<Eigen::Index, 5> strides{1, 2, 1, 2, 1};

}  // namespace

PanoramaLayer panorama_layer(const TensorFile& file, const std::string& name, std::size_t dimensions,
                             const std::string& network) {
  const auto weight = file.tensors.find(name + ".weight"), bias = file.tensors.find(name + ".bias");
  if (weight == file.tensors.end() || bias == file.tensors.end() || weight->second.shape.size() != dimensions ||
      weight->second.type == TensorType::int32 || bias->second.type == TensorType::int32)
    throw InputError(network + " lack the layer " + name + ".");
  const std::vector<std::int64_t>& shape = weight->second.shape;
  const std::vector<float> values = load_floats(weight->second), biases = load_floats(bias->second);
  PanoramaLayer result;
  result.inputs = shape[1];
  if (dimensions == 4) result.kernel_rows = shape[2];
  if (dimensions > 2) result.kernel_columns = shape.back();
  result.weight = Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      values.data(), shape[0], static_cast<Eigen::Index>(values.size()) / std::max<Eigen::Index>(1, shape[0]));
  result.bias = Eigen::Map<const Eigen::VectorXf>(biases.data(), static_cast<Eigen::Index>(biases.size()));
  if (result.bias.size() != result.weight.rows() || !result.weight.allFinite() || !result.bias.allFinite())
    throw InputError(network + " are damaged in the layer " + name + ".");
  return result;
}

Eigen::MatrixXf convolved_around(const Eigen::MatrixXf& around, const PanoramaLayer& layer) {
  return convolved({around, 1, around.cols()}, layer, 1).values;
}

CrownPanorama mirrored(const CrownPanorama& panorama) {
  constexpr std::size_t columns = CrownPanorama::columns, lines = CrownPanorama::channels * CrownPanorama::rows;
  constexpr std::size_t along_columns = 3;  // the channel that changes its sign
  CrownPanorama result = panorama;
  for (std::size_t line = 0; line < lines; ++line) {
    const auto begin = result.values.begin() + static_cast<std::ptrdiff_t>(line * columns);
    std::reverse(begin, begin + static_cast<std::ptrdiff_t>(columns));
    if (line / CrownPanorama::rows == along_columns)
      std::transform(begin, begin + static_cast<std::ptrdiff_t>(columns), begin, [](float x) { return -x; });
  }
  return result;
}

PanoramaFeatures::PanoramaFeatures(const TensorFile& file, const std::string& network) {
  for (std::size_t i = 0; i < strides.size(); ++i)
    maps_.push_back(panorama_layer(file, "maps." + std::to_string(i), 4, network));
  for (std::size_t i = 0; i < 3; ++i)
    around_.push_back(panorama_layer(file, "around." + std::to_string(i), 3, network));

  Eigen::Index channels = CrownPanorama::channels + 1, rows = CrownPanorama::rows;
  // Kernels have a middle, and none is wider than the narrowest map.
  const auto is_centred = [](const PanoramaLayer& layer) {
    return layer.kernel_rows % 2 == 1 && layer.kernel_columns % 2 == 1 &&
           layer.kernel_columns <= static_cast<Eigen::Index>(CrownPanorama::columns) / columns_per_place;
  };
  bool fits =
      std::all_of(maps_.begin(), maps_.end(), is_centred) && std::all_of(around_.begin(), around_.end(), is_centred);
  for (std::size_t i = 0; i < maps_.size(); ++i) {
    fits = fits && maps_[i].inputs == channels;
    channels = maps_[i].weight.rows(), rows /= strides[i];
  }
  channels *= rows;
  for (const PanoramaLayer& convolution : around_) {
    fits = fits && convolution.inputs == channels;
    channels = convolution.weight.rows();
  }
  fits = fits && around_[1].weight.rows() == around_[2].weight.rows();
  if (!fits) throw InputError(network + " do not fit each other.");
}

Eigen::MatrixXf PanoramaFeatures::operator()(const CrownPanorama& panorama) const {
  constexpr auto channels = static_cast<Eigen::Index>(CrownPanorama::channels);
  constexpr auto rows = static_cast<Eigen::Index>(CrownPanorama::rows);
  constexpr auto columns = static_cast<Eigen::Index>(CrownPanorama::columns);
  Map map{Eigen::MatrixXf(channels + 1, rows * columns), rows, columns};
  map.values.topRows(channels) =
      Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(panorama.values.data(),
                                                                                              channels, rows * columns);
  for (Eigen::Index r = 0; r < rows; ++r)  // the last channel says which row it is, -1 to 1
    map.values.row(channels)
        .segment(r * columns, columns)
        .setConstant(2 * static_cast<float>(r) / static_cast<float>(rows - 1) - 1);
  for (std::size_t i = 0; i < maps_.size(); ++i) map = convolved(map, maps_[i], strides[i]);
  // From here on a column is one place with all that lies above it.
  Eigen::MatrixXf around(map.values.rows() * map.rows, map.columns);
  for (Eigen::Index k = 0; k < map.values.rows(); ++k)
    for (Eigen::Index r = 0; r < map.rows; ++r)
      around.row(k * map.rows + r) = map.values.row(k).segment(r * map.columns, map.columns);
  around = convolved_around(convolved_around(around, around_[0]), around_[1]);
  return around + convolved_around(around, around_[2]);
}

}  // namespace rhizodont
