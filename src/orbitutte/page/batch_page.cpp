// SPDX-License-Identifier: MIT
#include "orbitutte/page/batch_page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cctype>
#include <cmath>
#include <map>

#include "orbitutte/export/html_text.h"
#include "orbitutte/page/html_template.h"
#include "orbitutte/page/page_assets.h"
#include "orbitutte/page/page_frame.h"

namespace orbitutte {
namespace {

// A file's name as part of an address: all but letters, digits and a few marks as %XX.
std::string address_of(const std::string& name) {
  std::string address;
  for (const unsigned char c : name)
    address += std::isalnum(c) || c == '-' || c == '_' || c == '.' ? std::string(1, static_cast<char>(c))
                                                                   : fmt::format("%{:02X}", c);
  return address;
}

std::string decimals(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "–";
}

// "not certified (exit code 5)"
std::string ending_of(const JobRecord& record) {
  std::string words = name_of(record.outcome);
  for (char& c : words) c = c == '_' ? ' ' : c;
  if (record.exit_code && *record.exit_code != 0)
    return fmt::format("{} (exit code {})", words, *record.exit_code);
  return record.signal ? fmt::format("{} (signal {})", words, *record.signal) : words;
}

Content job_row(const JobRecord& record) {
  const JobNumbers numbers = record.numbers.value_or(JobNumbers());
  const bool has_numbers = record.numbers.has_value();
  const bool is_certified = record.outcome == JobOutcome::certified;
  return {{"name", record.name},
          {"address", address_of(record.name)},
          {"mesh", record.mesh},
          {"is_embedded", is_embedded(record.outcome)},
          {"state", is_certified ? "good" : "bad"},
          {"ending", ending_of(record)},
          {"message", record.message.empty() ? Content(false) : Content(record.message)},
          {"orbifold", has_numbers ? numbers.orbifold : "–"},
          {"faces", has_numbers ? grouped_digits(numbers.faces) : "–"},
          {"sigma", has_numbers ? decimals(numbers.sigma, 3) : "–"},
          {"within_4", has_numbers ? decimals(100 * numbers.within_4, 1) : "–"},
          {"below_64", has_numbers ? decimals(100 * numbers.below_64, 1) : "–"},
          {"seconds", decimals(record.seconds, 2)}};
}

// "not certified (exit code 5)" and how often, the certified first.
Content counts_of(const std::vector<JobRecord>& records) {
  std::map<std::pair<JobOutcome, std::string>, int> counts;
  for (const JobRecord& record : records) ++counts[{record.outcome, ending_of(record)}];
  Content rows = Content::array();
  for (const auto& [ending, count] : counts)
    rows.push_back({{"ending", ending.second}, {"count", grouped_digits(count)}});
  return rows;
}

}  // namespace

std::string batch_page(const std::vector<JobRecord>& records, std::size_t missing) {
  Content jobs = Content::array();
  long long certified = 0;
  double seconds = 0;
  for (const JobRecord& record : records) {
    jobs.push_back(job_row(record));
    certified += record.outcome == JobOutcome::certified;
    seconds += record.seconds;
  }
  const auto count = static_cast<long long>(records.size()) + static_cast<long long>(missing);
  const bool all_are_certified = missing == 0 && certified == static_cast<long long>(records.size());
  Content content = {{"count", grouped_digits(count)},
                     {"jobs_word", count == 1 ? "job" : "jobs"},
                     {"certified", grouped_digits(certified)},
                     {"verdict", all_are_certified ? "good" : "bad"},
                     {"is_unfinished", missing > 0},
                     {"missing", grouped_digits(static_cast<long long>(missing))},
                     {"seconds", decimals(seconds, 1)},
                     {"counts", counts_of(records)},
                     {"jobs", std::move(jobs)}};
  add_frame({}, content);
  return fill_template(framed_template(batch_template, {}), content);
}

}  // namespace orbitutte
