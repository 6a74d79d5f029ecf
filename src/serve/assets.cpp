// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "serve/assets.hpp"

#include <algorithm>
#include <array>
#include <utility>

namespace rhizodont::serve {

const Asset* find_asset(std::string_view name) {
  const auto& all = service_assets();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Asset& asset) { return asset.name == name; });
  return found == all.end() ? nullptr : &*found;
}

const char* media_type(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, const char*>, 10> types{{{".html", "text/html; charset=utf-8"},
                                                                            {".js", "text/javascript; charset=utf-8"},
                                                                            {".css", "text/css; charset=utf-8"},
                                                                            {".svg", "image/svg+xml"},
                                                                            {".json", "application/json"},
                                                                            {".zip", "application/zip"},
                                                                            {".png", "image/png"},
                                                                            {".glb", "model/gltf-binary"},
                                                                            {".stl", "model/stl"},
                                                                            {".obj", "model/obj"}}};
  for (const auto& [ending, type] : types)
    if (name.ends_with(ending)) return type;
  return "application/octet-stream";
}

}  // namespace rhizodont::serve
