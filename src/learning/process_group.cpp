// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "learning/process_group.hpp"

#include <torch/csrc/distributed/c10d/ProcessGroupGloo.hpp>
#include <torch/csrc/distributed/c10d/TCPStore.hpp>

#include <charconv>

#include "base/option_range.hpp"
#include "rhizodont/error.hpp"

namespace rhizodont {
namespace {

constexpr std::chrono::minutes patience{5};

std::uint16_t port_of(const std::string& address, std::size_t colon) {
  unsigned port = 0;
  const char* const end = address.data() + address.size();
  const char* const begin = colon == std::string::npos ? end : address.data() + colon + 1;
  const auto [last, failure] = std::from_chars(begin, end, port);
  if (failure != std::errc() || last != end || port == 0 || port > 65535 || colon == 0)
    throw UsageError("The address of the first process must be HOST:PORT.");
  return static_cast<std::uint16_t>(port);
}

/// One flat tensor for many small ones: a round over the network for each would cost more than its bytes.
torch::Tensor flattened(const std::vector<torch::Tensor>& tensors) {
  std::vector<torch::Tensor> parts;
  for (const torch::Tensor& tensor : tensors) parts.push_back(tensor.reshape({-1}));
  return torch::cat(parts);
}

void unflatten(const torch::Tensor& flat, std::vector<torch::Tensor>& tensors) {
  std::int64_t at = 0;
  for (torch::Tensor& tensor : tensors) {
    tensor.copy_(flat.narrow(0, at, tensor.numel()).view(tensor.sizes()));
    at += tensor.numel();
  }
}

[[noreturn]] void lost(const std::exception& error) {
  throw InputError(std::string("The processes that train together have lost each other: ") + error.what());
}

}  // namespace

struct ProcessGroup::Connection {
  c10::intrusive_ptr<c10d::TCPStore> store;
  c10::intrusive_ptr<c10d::ProcessGroupGloo> group;
};

void require_in_range(const ProcessOptions& options) {
  require_ranges("training together", {{"count", options.count, OptionRange::at_least(1)},
                                       {"rank", options.rank, OptionRange::at_least(0).below(options.count)}});
}

ProcessGroup::ProcessGroup(const ProcessOptions& options) : size_(options.count), rank_(options.rank) {
  require_in_range(options);
  if (size_ == 1) return;
  const std::size_t colon = options.first_address.rfind(':');
  c10d::TCPStoreOptions store;
  store.port = port_of(options.first_address, colon);
  store.isServer = rank_ == 0;
  store.numWorkers = static_cast<std::size_t>(size_);
  store.timeout = patience;
  const std::string host = options.first_address.substr(0, colon);
  try {
    connection_ = std::make_unique<Connection>();
    connection_->store = c10::make_intrusive<c10d::TCPStore>(host, store);
    auto settings = c10d::ProcessGroupGloo::Options::create();
    settings->timeout = std::chrono::duration_cast<std::chrono::milliseconds>(6 * patience);
    // Each process is reached where it reaches the first: over the loopback only if that is where the first one is.
    const bool local = host == "127.0.0.1" || host == "localhost";
    settings->devices.push_back(local ? c10d::ProcessGroupGloo::createDeviceForHostname("127.0.0.1")
                                      : c10d::ProcessGroupGloo::createDefaultDevice());
    connection_->group = c10::make_intrusive<c10d::ProcessGroupGloo>(connection_->store, rank_, size_, settings);
  } catch (const std::exception& error) {
    throw InputError("The processes that are to train together do not find each other at " + options.first_address +
                     ": " + error.what());
  }
}

ProcessGroup::~ProcessGroup() = default;

void ProcessGroup::share(std::vector<torch::Tensor> tensors) const {
  if (size_ == 1) return;
  torch::NoGradGuard no_gradient;
  try {
    for (torch::Tensor& tensor : tensors) {
      std::vector<torch::Tensor> one{tensor};
      connection_->group->broadcast(one)->wait();
    }
  } catch (const std::exception& error) {
    lost(error);
  }
}

void ProcessGroup::sum(std::vector<torch::Tensor> tensors) const {
  if (size_ == 1 || tensors.empty()) return;
  torch::NoGradGuard no_gradient;
  try {
    std::vector<torch::Tensor> flat{flattened(tensors)};
    connection_->group->allreduce(flat)->wait();
    unflatten(flat.front(), tensors);
  } catch (const std::exception& error) {
    lost(error);
  }
}

std::int64_t ProcessGroup::share(std::int64_t value) const {
  if (size_ == 1) return value;
  const torch::Tensor one = torch::full({1}, value, torch::kLong);
  share({one});
  return one.item<std::int64_t>();
}

}  // namespace rhizodont
