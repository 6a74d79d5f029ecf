// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "learning/weights.hpp"

namespace rhizodont {

/// A network (a torch module's holder) with the parameters that a file of weights has for it. Throws as load_tensor.
template <class Network>
Network with_weights(Network network, const TensorFile& file) {
  for (auto& item : network->named_parameters()) load_tensor(file, item.key(), item.value());
  return network;
}

}  // namespace rhizodont
