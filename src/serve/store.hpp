// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

namespace rhizodont::serve {

/// 128 bits of the system's randomness in hex: who was not told an id does not guess it.
std::string random_id();

/// Things by random ids, in memory alone. A thing is forgotten when nobody has asked for it for long, or when newer
/// ones need its place. Whoever holds one keeps it alive. May be used from several threads.
template <class Thing>
class Store {
 public:
  /// @param may_go  whether a thing may make place for a newer one (a job at work may not)
  Store(std::size_t most, std::chrono::seconds expiry, std::function<bool(const Thing&)> may_go = {})
      : most_(most), expiry_(expiry), may_go_(std::move(may_go)) {}

  /// False if all places are taken by things that may not go.
  bool add(const std::string& id, std::shared_ptr<Thing> thing) {
    const std::scoped_lock lock(mutex_);
    forget_expired();
    if (entries_.size() >= most_ && !forget_oldest()) return false;
    entries_[id] = {std::move(thing), Clock::now()};
    return true;
  }

  /// Null if there is none.
  std::shared_ptr<Thing> find(const std::string& id) {
    const std::scoped_lock lock(mutex_);
    const auto place = entries_.find(id);
    if (place == entries_.end()) return nullptr;
    place->second.asked = Clock::now();
    return place->second.thing;
  }

  std::shared_ptr<Thing> take(const std::string& id) {
    const std::scoped_lock lock(mutex_);
    const auto place = entries_.find(id);
    if (place == entries_.end()) return nullptr;
    std::shared_ptr<Thing> thing = std::move(place->second.thing);
    entries_.erase(place);
    return thing;
  }

  template <class Function>
  void for_each(const Function& function) {
    const std::scoped_lock lock(mutex_);
    for (auto& [id, entry] : entries_) function(*entry.thing);
  }

  void expire() {
    const std::scoped_lock lock(mutex_);
    forget_expired();
  }

  std::size_t size() const {
    const std::scoped_lock lock(mutex_);
    return entries_.size();
  }

 private:
  using Clock = std::chrono::steady_clock;
  struct Entry {
    std::shared_ptr<Thing> thing;
    Clock::time_point asked;
  };

  bool may_go(const Entry& entry) const { return !may_go_ || may_go_(*entry.thing); }

  void forget_expired() {
    const auto now = Clock::now();
    std::erase_if(entries_, [&](const auto& e) { return may_go(e.second) && now - e.second.asked > expiry_; });
  }

  bool forget_oldest() {
    auto oldest = entries_.end();
    for (auto place = entries_.begin(); place != entries_.end(); ++place)
      if (may_go(place->second) && (oldest == entries_.end() || place->second.asked < oldest->second.asked))
        oldest = place;
    if (oldest == entries_.end()) return false;
    entries_.erase(oldest);
    return true;
  }

  std::size_t most_;
  std::chrono::seconds expiry_;
  std::function<bool(const Thing&)> may_go_;
  mutable std::mutex mutex_;
  std::map<std::string, Entry> entries_;
};

}  // namespace rhizodont::serve
