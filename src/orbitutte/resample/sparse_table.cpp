// SPDX-License-Identifier: MIT
#include "orbitutte/resample/sparse_table.h"

#include <fmt/format.h>

#include <algorithm>
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

}  // namespace orbitutte
