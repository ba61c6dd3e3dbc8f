// SPDX-License-Identifier: MIT
// P. R. Amestoy, I. S. Duff, J. Koster, J.-Y. L'Excellent, "A fully asynchronous multifrontal solver using
// distributed dynamic scheduling", SIAM Journal on Matrix Analysis and Applications 23 (2001).
#include "orbitutte/verify/mumps_inertia.h"

#ifdef ORBITUTTE_HAS_MUMPS

#include <dmumps_c.h>
#include <fmt/format.h>

#include <mutex>
#include <utility>

namespace orbitutte {
namespace {

std::mutex& mumps_mutex() {
  static std::mutex mutex;
  return mutex;
}

enum Job { finish = -2, start = -1, analyse = 1, factorize = 2 };

constexpr int general_symmetric = 2, use_comm_world = -987654, workspace_too_small = -9;

class MumpsCounter : public InertiaCounter {
 public:
  MumpsCounter(const SymmetricMatrix& lower, Eigen::VectorXd scale)
      : lower_(lower), scale_(std::move(scale)), values_(lower.nonZeros()) {
    const std::lock_guard lock(mumps_mutex());
    mumps_.par = 1;
    mumps_.sym = general_symmetric;
    mumps_.comm_fortran = use_comm_world;
    run(start);
    list_entries();
    set_controls();
    run(analyse);
    if (failed()) throw_and_finish();
  }

  ~MumpsCounter() override {
    const std::lock_guard lock(mumps_mutex());
    run(finish);
  }
  MumpsCounter(const MumpsCounter&) = delete;
  MumpsCounter& operator=(const MumpsCounter&) = delete;

  long eigenvalues_below(double shift) override {
    const std::lock_guard lock(mumps_mutex());
    shift_values(shift);
    run(factorize);
    while (mumps_.info[0] == workspace_too_small && icntl(14) < 1000) {
      icntl(14) *= 2;
      run(factorize);
    }
    if (failed()) throw InertiaNotFound(failure());
    return mumps_.infog[11];  // INFOG(12): the number of negative pivots
  }

 private:
  int& icntl(int number) { return mumps_.icntl[number - 1]; }

  void run(Job job) {
    mumps_.job = job;
    dmumps_c(&mumps_);
  }

  bool failed() const { return mumps_.info[0] < 0; }
  std::string failure() const {
    return fmt::format("MUMPS gave up with code {} ({})", mumps_.info[0], mumps_.info[1]);
  }

  [[noreturn]] void throw_and_finish() {
    const std::string message = failure();
    run(finish);
    throw InertiaNotFound(message);
  }

  /// Lists rows and columns, counted from 1, column by column.
  void list_entries() {
    for (int column = 0; column < lower_.outerSize(); ++column) {
      for (SymmetricMatrix::InnerIterator entry(lower_, column); entry; ++entry) {
        rows_.push_back(static_cast<int>(entry.row()) + 1);
        columns_.push_back(column + 1);
      }
    }
    mumps_.n = static_cast<int>(lower_.rows());
    mumps_.nnz = static_cast<MUMPS_INT8>(rows_.size());
    mumps_.irn = rows_.data();
    mumps_.jcn = columns_.data();
    mumps_.a = values_.data();
  }

  void set_controls() {
    for (const int output : {1, 2, 3}) icntl(output) = -1;  // print nothing
    icntl(4) = 0;
    // The ordering uses the pattern alone, since values change between analysis and factorisation.
    icntl(12) = 1;
    icntl(13) = 1;   // no ScaLAPACK, which would not count negative pivots
    icntl(14) = 50;  // per cent of spare memory for pivoting
    icntl(31) = 1;   // L is not kept, since only the pivots are needed
  }

  void shift_values(double shift) {
    for (std::size_t k = 0; k < values_.size(); ++k) {
      const bool diagonal = rows_[k] == columns_[k];
      values_[k] = lower_.valuePtr()[k] - (diagonal ? shift * scale_[rows_[k] - 1] : 0);
    }
  }

  SymmetricMatrix lower_;
  Eigen::VectorXd scale_;
  std::vector<int> rows_, columns_;
  std::vector<double> values_;
  DMUMPS_STRUC_C mumps_ = {};
};

}  // namespace

std::unique_ptr<InertiaCounter> mumps_inertia_counter(const SymmetricMatrix& lower,
                                                      const Eigen::VectorXd& scale) {
  return std::make_unique<MumpsCounter>(lower, scale);
}

}  // namespace orbitutte

#endif
