// SPDX-License-Identifier: MIT
// What a long computation reports while it runs, and how long each of its stages took.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte {

/// Where the computation is. `iteration`, `energy` and `gradient_norm` are only meaningful in the stage
/// "optimize".
struct Progress {
  /// "validate", "weights", "cut", "factorize", "initialize", "optimize", "certify", "mend", ...
  std::string stage;
  int iteration = 0;
  double energy = 0;
  double gradient_norm = 0;
};

/// Returning false cancels: embed throws Cancelled.
using ProgressCallback = std::function<bool(const Progress&)>;

/// Wall-clock seconds per stage, in the order in which they ran; a stage that ran again has further entries.
using Timings = std::vector<std::pair<std::string, double>>;

/// Runs the stages, reports each and times it.
class Stages {
 public:
  Stages(const ProgressCallback& progress, Timings& timings) : progress_(progress), timings_(timings) {}

  template <typename Step>
  auto operator()(const char* stage, const Step& step) {
    tell({stage});
    const Clock clock(stage, timings_);
    return step();
  }

  void tell(const Progress& progress) const {
    if (progress_ && !progress_(progress)) throw Cancelled();
  }

 private:
  class Clock {
   public:
    Clock(const char* stage, Timings& timings) : stage_(stage), timings_(timings) {}
    ~Clock() {
      const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start_;
      timings_.emplace_back(stage_, passed.count());
    }

   private:
    const char* stage_;
    Timings& timings_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  };

  const ProgressCallback& progress_;
  Timings& timings_;
};

}  // namespace orbitutte
