// SPDX-License-Identifier: MIT
#include "orbitutte/resample/sparse_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "orbitutte/errors.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

using TableEntry = std::pair<int, double>;  // a column and its weight

constexpr double no_value = std::numeric_limits<double>::quiet_NaN();

// The entries of a row with ascending columns, each once and none of them zero.
void tidy_entries(std::vector<TableEntry>& entries) {
  std::stable_sort(entries.begin(), entries.end(),
                   [](const TableEntry& a, const TableEntry& b) { return a.first < b.first; });
  std::size_t kept = 0;
  for (std::size_t k = 0; k < entries.size();) {
    TableEntry sum = entries[k++];
    while (k < entries.size() && entries[k].first == sum.first) sum.second += entries[k++].second;
    if (sum.second != 0) entries[kept++] = sum;
  }
  entries.resize(kept);
}

// fill(row, entries) puts the entries of a row, tidy, into an empty vector. The rows are made in ranges on
// all threads, and then strung together.
template <typename Fill>
SparseTable table_from_rows(int rows, int columns, const Fill& fill) {
  constexpr int length = 8192;
  struct Part {
    std::vector<int> index;
    std::vector<double> weight;
  };
  std::vector<Part> parts((rows + length - 1) / length);
  SparseTable table;
  table.columns = columns;
  table.start.assign(rows + 1, 0);
  parallel_for(static_cast<int>(parts.size()), [&](int p) {
    std::vector<TableEntry> entries;
    for (int r = p * length, end = std::min(rows - r, length) + r; r < end; ++r) {
      entries.clear();
      fill(r, entries);
      for (const auto& [column, weight] : entries) {
        parts[p].index.push_back(column);
        parts[p].weight.push_back(weight);
      }
      table.start[r + 1] = static_cast<int>(entries.size());
    }
  });
  long long total = 0;
  for (int r = 0; r < rows; ++r) {
    total += table.start[r + 1];
    if (total > std::numeric_limits<int>::max())
      throw ArgumentError("the table has more than 2^31 - 1 weights; take a coarser grid");
    table.start[r + 1] = static_cast<int>(total);
  }
  table.index.resize(total);
  table.weight.resize(total);
  parallel_for(static_cast<int>(parts.size()), [&](int p) {
    std::copy(parts[p].index.begin(), parts[p].index.end(), table.index.begin() + table.start[p * length]);
    std::copy(parts[p].weight.begin(), parts[p].weight.end(), table.weight.begin() + table.start[p * length]);
  });
  return table;
}

void require_a_value_each(const SparseTable& table, const Eigen::MatrixXd& values) {
  if (values.rows() != table.columns)
    throw ArgumentError(
        fmt::format("there are {} values for {} vertices or points", values.rows(), table.columns));
}

// The label whose weights add up to the most.
double heaviest(std::vector<std::pair<double, double>>& labels) {
  std::stable_sort(labels.begin(), labels.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  double best = no_value, most = -1;
  for (std::size_t k = 0; k < labels.size();) {
    const double label = labels[k].first;
    double sum = 0;
    while (k < labels.size() && labels[k].first == label) sum += labels[k++].second;
    if (sum > most) most = sum, best = label;
  }
  return best;
}

// Labels as numbers 0 .. count - 1; NaN is the last one.
class LabelNumbers {
 public:
  explicit LabelNumbers(const Eigen::VectorXd& labels) : values_(labels.begin(), labels.end()) {
    std::erase_if(values_, [](double value) { return std::isnan(value); });
    std::sort(values_.begin(), values_.end());
    values_.erase(std::unique(values_.begin(), values_.end()), values_.end());
  }

  int count() const { return static_cast<int>(values_.size()) + 1; }
  int number(double label) const {
    if (std::isnan(label)) return count() - 1;
    return static_cast<int>(std::lower_bound(values_.begin(), values_.end(), label) - values_.begin());
  }
  double label(int number) const {
    return number + 1 < count() ? values_[static_cast<std::size_t>(number)] : no_value;
  }

 private:
  std::vector<double> values_;
};

// The labels in the rows of a table: as a table from labels.
SparseTable labels_of_rows(const SparseTable& table, const std::vector<int>& numbers, int count) {
  return table_from_rows(table.rows(), count, [&](int r, std::vector<TableEntry>& entries) {
    for (int k = table.start[r]; k < table.start[r + 1]; ++k)
      entries.emplace_back(numbers[static_cast<std::size_t>(table.index[k])], table.weight[k]);
    tidy_entries(entries);
  });
}

// The label of a row with the largest share minus its price; -1 if there is none.
int dearest_label(const SparseTable& shares, const Eigen::VectorXd& prices, int row) {
  int best = -1;
  double most = -std::numeric_limits<double>::infinity();
  for (int k = shares.start[row]; k < shares.start[row + 1]; ++k) {
    const double gain = shares.weight[k] - prices[shares.index[k]];
    if (gain > most) most = gain, best = shares.index[k];
  }
  return best;
}

// Rows with one label have it whatever the prices; the others choose.
struct LabelChoices {
  const SparseTable& shares;
  const Eigen::VectorXd &row_areas, &wanted;
  std::vector<int> choosing = {};
  Eigen::VectorXd settled = {};

  LabelChoices(const SparseTable& of_rows, const Eigen::VectorXd& areas, const Eigen::VectorXd& of_labels)
      : shares(of_rows),
        row_areas(areas),
        wanted(of_labels),
        settled(Eigen::VectorXd::Zero(of_labels.size())) {
    choosing.reserve(static_cast<std::size_t>(shares.rows()));
    for (int r = 0; r < shares.rows(); ++r) {
      const int labels = shares.start[r + 1] - shares.start[r];
      if (labels == 1) settled[shares.index[shares.start[r]]] += row_areas[r];
      if (labels > 1) choosing.push_back(r);
    }
  }

  // By how much of itself each label is too large: (area - wanted) / wanted; 0 for labels without area.
  Eigen::VectorXd excess(const Eigen::VectorXd& prices) const {
    Eigen::VectorXd areas = settled;
    for (const int r : choosing) areas[dearest_label(shares, prices, r)] += row_areas[r];
    return (wanted.array() > 0).select((areas - wanted).cwiseQuotient(wanted), 0);
  }
};

// The prices with the least excess that were found. A label that is too large becomes dearer, by steps that
// grow while that is so, and halve where it changes (M. Riedmiller, H. Braun, 1993).
Eigen::VectorXd prices_of_labels(const LabelChoices& choices) {
  constexpr double enough = 1e-3, first_step = 0.02, longest_step = 0.2;
  constexpr int most_steps = 300;
  const Eigen::Index count = choices.wanted.size();
  Eigen::VectorXd prices = Eigen::VectorXd::Zero(count), best = prices, before = prices,
                  step = Eigen::VectorXd::Constant(count, first_step);
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < most_steps && least > enough; ++k) {
    const Eigen::VectorXd excess = choices.excess(prices);
    if (const double largest = excess.cwiseAbs().maxCoeff(); largest < least) least = largest, best = prices;
    for (Eigen::Index label = 0; label < count; ++label) {
      const double same = excess[label] * before[label];
      step[label] = same > 0   ? std::min(1.2 * step[label], longest_step)
                    : same < 0 ? step[label] / 2
                               : step[label];
      if (excess[label] != 0) prices[label] += std::copysign(step[label], excess[label]);
    }
    before = excess;
  }
  return best;
}

}  // namespace

SparseTable table_of_stencils(int columns, const std::vector<Stencil>& stencils, int stencils_per_row) {
  const int rows = static_cast<int>(stencils.size()) / stencils_per_row;
  return table_from_rows(rows, columns, [&](int r, std::vector<TableEntry>& entries) {
    for (int s = 0; s < stencils_per_row; ++s) {
      const Stencil& stencil = stencils[static_cast<std::size_t>(r) * stencils_per_row + s];
      for (int k = 0; k < stencil.count; ++k)
        entries.emplace_back(stencil.index[k], stencil.weight[k] / stencils_per_row);
    }
    tidy_entries(entries);
  });
}

SparseTable largest_weights(const SparseTable& table) {
  return table_from_rows(table.rows(), table.columns, [&](int r, std::vector<TableEntry>& entries) {
    const auto begin = table.weight.begin() + table.start[r], end = table.weight.begin() + table.start[r + 1];
    if (begin != end)
      entries.emplace_back(table.index[std::max_element(begin, end) - table.weight.begin()], 1.0);
  });
}

SparseTable transposed(const SparseTable& table) {
  SparseTable result;
  result.columns = table.rows();
  result.start.assign(table.columns + 1, 0);
  result.index.resize(table.index.size());
  result.weight.resize(table.weight.size());
  for (const int column : table.index) ++result.start[column + 1];
  for (int c = 0; c < table.columns; ++c) result.start[c + 1] += result.start[c];
  std::vector<int> next(result.start.begin(), result.start.end() - 1);
  for (int r = 0; r < table.rows(); ++r)
    for (int k = table.start[r]; k < table.start[r + 1]; ++k) {
      const int at = next[table.index[k]]++;
      result.index[at] = r;
      result.weight[at] = table.weight[k];
    }
  return result;
}

SparseTable sum_of(const ScaledTable& a, const ScaledTable& b) {
  return table_from_rows(a.table.rows(), a.table.columns, [&](int r, std::vector<TableEntry>& entries) {
    for (const ScaledTable* const part : {&a, &b})
      for (int k = part->table.start[r]; k < part->table.start[r + 1]; ++k)
        entries.emplace_back(part->table.index[k], part->factors[r] * part->table.weight[k]);
    tidy_entries(entries);
  });
}

Eigen::VectorXd row_sums(const SparseTable& table) {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(table.rows());
  for (int r = 0; r < table.rows(); ++r)
    for (int k = table.start[r]; k < table.start[r + 1]; ++k) sums[r] += table.weight[k];
  return sums;
}

void scale_rows(SparseTable& table, const Eigen::VectorXd& factors) {
  for (int r = 0; r < table.rows(); ++r)
    for (int k = table.start[r]; k < table.start[r + 1]; ++k) table.weight[k] *= factors[r];
}

void normalize_rows(SparseTable& table) {
  const Eigen::VectorXd sums = row_sums(table);
  int kept = 0;
  for (int r = 0, begin = 0; r < table.rows(); ++r) {
    const int end = table.start[r + 1];
    for (int k = begin; k < end && sums[r] != 0; ++k, ++kept) {
      table.index[kept] = table.index[k];
      table.weight[kept] = table.weight[k] / sums[r];
    }
    begin = end;
    table.start[r + 1] = kept;
  }
  table.index.resize(kept);
  table.weight.resize(kept);
}

Eigen::MatrixXd apply(const SparseTable& table, const Eigen::MatrixXd& values) {
  require_a_value_each(table, values);
  Eigen::MatrixXd result(table.rows(), values.cols());
  parallel_ranges(table.rows(), [&](int begin, int end) {
    for (Eigen::Index map = 0; map < values.cols(); ++map)
      for (int r = begin; r < end; ++r) {
        double sum = table.start[r] < table.start[r + 1] ? 0 : no_value;
        for (int k = table.start[r]; k < table.start[r + 1]; ++k)
          sum += table.weight[k] * values(table.index[k], map);
        result(r, map) = sum;
      }
  });
  return result;
}

Eigen::MatrixXd apply_to_labels(const SparseTable& table, const Eigen::MatrixXd& labels) {
  require_a_value_each(table, labels);
  Eigen::MatrixXd result(table.rows(), labels.cols());
  parallel_ranges(table.rows(), [&](int begin, int end) {
    std::vector<std::pair<double, double>> of_row;
    for (Eigen::Index map = 0; map < labels.cols(); ++map)
      for (int r = begin; r < end; ++r) {
        of_row.clear();
        for (int k = table.start[r]; k < table.start[r + 1]; ++k)
          of_row.emplace_back(labels(table.index[k], map), table.weight[k]);
        result(r, map) = heaviest(of_row);
      }
  });
  return result;
}

Eigen::MatrixXd labels_keeping_areas(const SparseTable& table, const Eigen::MatrixXd& labels,
                                     const TableAreas& areas) {
  require_a_value_each(table, labels);
  if (areas.rows.size() != table.rows() || areas.columns.size() != table.columns)
    throw ArgumentError(fmt::format("there are areas of {} rows and {} columns, but the table is {} x {}",
                                    areas.rows.size(), areas.columns.size(), table.rows(), table.columns));
  Eigen::MatrixXd result(table.rows(), labels.cols());
  for (Eigen::Index map = 0; map < labels.cols(); ++map) {
    const LabelNumbers known(labels.col(map));
    std::vector<int> numbers(static_cast<std::size_t>(table.columns));
    Eigen::VectorXd wanted = Eigen::VectorXd::Zero(known.count());
    for (int c = 0; c < table.columns; ++c) {
      numbers[static_cast<std::size_t>(c)] = known.number(labels(c, map));
      wanted[numbers[static_cast<std::size_t>(c)]] += areas.columns[c];
    }
    const SparseTable shares = labels_of_rows(table, numbers, known.count());
    const Eigen::VectorXd prices = prices_of_labels({shares, areas.rows, wanted});
    for (int r = 0; r < table.rows(); ++r) {
      const int label = dearest_label(shares, prices, r);
      result(r, map) = label < 0 ? no_value : known.label(label);
    }
  }
  return result;
}

}  // namespace orbitutte
