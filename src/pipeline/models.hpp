// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "completion/likeness.hpp"
#include "completion/mean_crowns.hpp"
#include "completion/pose_network.hpp"
#include "networks/completion_network.hpp"
#include "networks/surface_network.hpp"
#include "rhizodont/complete.hpp"
#include "segment/arch_model.hpp"

#include <array>
#include <memory>
#include <optional>

namespace rhizodont {

inline constexpr const char* completion_file = "completion.safetensors";
inline constexpr const char* atlas_file = "atlas.safetensors";

/// The files without which nothing can be completed.
inline constexpr std::array needed_model_files{completion_file, atlas_file};

struct CompletionModels::Content {
  Atlas atlas;
  CompletionNetwork network;
  std::optional<SurfaceNetwork> skirt;
  std::optional<LikenessModel> likeness;
  std::optional<ArchModel> arch;
  std::optional<PoseNetwork> pose;
};

/// What the models are made of: for the rooms that run them.
const std::shared_ptr<const CompletionModels::Content>& content_of(const CompletionModels& models);

}  // namespace rhizodont
