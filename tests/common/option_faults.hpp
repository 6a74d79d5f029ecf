// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "rhizodont/error.hpp"

#include <gtest/gtest.h>

#include <concepts>
#include <exception>
#include <functional>
#include <initializer_list>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace rhizodont::test {

/// A call with one option out of its range.
struct Fault {
  std::string option;
  std::function<void()> call;
};

/// Collects the faults of one options struct.
template <class Options>
class Faults {
 public:
  using Use = std::function<void(const Options&)>;
  Faults(std::vector<Fault>& all, Use use) : all_(all), use_(std::move(use)) {}

  /// Values out of range; of a floating-point option also what is not a number.
  template <class Value>
  Faults& of(const std::string& name, Value Options::*option, std::initializer_list<Value> values) {
    std::vector<Value> bad(values);
    if constexpr (std::floating_point<Value>) bad.push_back(std::numeric_limits<Value>::quiet_NaN());
    for (const Value value : bad) set(name, [option, value](Options& options) { options.*option = value; });
    return *this;
  }
  Faults& set(const std::string& name, const std::function<void(Options&)>& spoil) {
    Options options;
    spoil(options);
    all_.push_back({name, [use = use_, options] { use(options); }});
    return *this;
  }

 private:
  std::vector<Fault>& all_;
  Use use_;
};

inline void expect_each_refused_by_name(const std::vector<Fault>& faults) {
  ASSERT_FALSE(faults.empty());
  for (const Fault& fault : faults) {
    SCOPED_TRACE(fault.option);
    try {
      fault.call();
      ADD_FAILURE() << "not refused";
    } catch (const UsageError& error) {
      const std::string sentence = error.what();
      EXPECT_NE(sentence.find("option " + fault.option + " of"), std::string::npos) << sentence;
      EXPECT_NE(sentence.find("out of its range: "), std::string::npos) << sentence;
    } catch (const std::exception& error) {
      ADD_FAILURE() << error.what();
    }
  }
}

}  // namespace rhizodont::test
