// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace rhizodont {

/// From 64-bit keys to indices >= 0: a hash table with open addressing, which is all that the tiling needs and several
/// times as fast as std::unordered_map. No key may have all bits set.
class IndexMap {
 public:
  explicit IndexMap(std::size_t expected = 1024) {
    std::size_t slots = 16;
    while (slots < 2 * expected) slots *= 2;
    slots_.assign(slots, {vacant, -1});
  }

  /// The index of `key`, -1 if there is none.
  std::int32_t find(std::uint64_t key) const { return slots_[slot(key)].second; }

  /// The index of `key`; a new key gets `index`. Second: whether it is new.
  std::pair<std::int32_t, bool> insert(std::uint64_t key, std::int32_t index) {
    if (2 * (size_ + 1) > slots_.size()) grow();
    auto& entry = slots_[slot(key)];
    if (entry.first == key) return {entry.second, false};
    entry = {key, index};
    ++size_;
    return {index, true};
  }

  std::size_t size() const { return size_; }

 private:
  static constexpr std::uint64_t vacant = ~std::uint64_t{0};

  std::size_t slot(std::uint64_t key) const {
    std::uint64_t hash = key;  // finaliser of splitmix64 (Steele, Lea and Flood 2014)
    hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9ULL;
    hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebULL;
    hash ^= hash >> 31;
    std::size_t at = hash & (slots_.size() - 1);
    while (slots_[at].first != key && slots_[at].first != vacant) at = (at + 1) & (slots_.size() - 1);
    return at;
  }

  void grow() {
    std::vector<std::pair<std::uint64_t, std::int32_t>> old(2 * slots_.size(), {vacant, -1});
    old.swap(slots_);
    for (const auto& entry : old)
      if (entry.first != vacant) slots_[slot(entry.first)] = entry;
  }

  std::vector<std::pair<std::uint64_t, std::int32_t>> slots_;
  std::size_t size_ = 0;
};

}  // namespace rhizodont
