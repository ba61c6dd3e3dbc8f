// SPDX-License-Identifier: MIT
#include "orbitutte/report/batch_record.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "orbitutte/errors.h"
#include "orbitutte/io/csv.h"

namespace orbitutte {
namespace {

using RecordJson = nlohmann::ordered_json;

RecordJson numbers_json(const JobNumbers& numbers) {
  const auto finite = [](double value) { return std::isfinite(value) ? RecordJson(value) : RecordJson(); };
  return {{"orbifold", numbers.orbifold},        {"cones", numbers.cones},
          {"vertices", numbers.vertices},        {"faces", numbers.faces},
          {"sigma", finite(numbers.sigma)},      {"within_4", finite(numbers.within_4)},
          {"below_64", finite(numbers.below_64)}};
}

RecordJson optional_json(const std::optional<int>& value) {
  return value ? RecordJson(*value) : RecordJson();
}

std::optional<int> optional_int(const RecordJson& value) {
  return value.is_null() ? std::nullopt : std::optional<int>(value.get<int>());
}

// JSON has no number that is not finite; null stands for it.
double number_of(const RecordJson& value) {
  return value.is_null() ? std::numeric_limits<double>::quiet_NaN() : value.get<double>();
}

JobNumbers numbers_from(const RecordJson& json) {
  return {json.at("orbifold").get<std::string>(),
          json.at("cones").get<std::vector<int>>(),
          json.at("vertices").get<int>(),
          json.at("faces").get<int>(),
          number_of(json.at("sigma")),
          number_of(json.at("within_4")),
          number_of(json.at("below_64"))};
}

JobRecord record_from(const RecordJson& json) {
  JobRecord record;
  record.job = json.at("job").get<std::size_t>();
  record.name = json.at("name").get<std::string>();
  record.mesh = json.at("mesh").get<std::string>();
  record.options = json.at("options").get<std::vector<std::string>>();
  record.outcome = parse_choice<JobOutcome>(json.at("outcome").get<std::string>(), "outcome");
  record.exit_code = optional_int(json.at("exit_code"));
  record.signal = optional_int(json.at("signal"));
  record.attempts = json.at("attempts").get<int>();
  record.seconds = json.at("seconds").get<double>();
  record.peak_memory_bytes = json.at("peak_memory_bytes").get<long long>();
  record.message = json.at("message").get<std::string>();
  record.warnings = json.at("warnings").get<std::vector<std::string>>();
  if (json.contains("numbers")) record.numbers = numbers_from(json.at("numbers"));
  return record;
}

std::string text_of(const std::optional<int>& value) { return value ? std::to_string(*value) : ""; }

std::string cell_of(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : ""; }

std::vector<std::string> summary_cells(const JobRecord& record) {
  std::vector<std::string> cells = {std::to_string(record.job),
                                    record.name,
                                    record.mesh,
                                    fmt::format("{}", fmt::join(record.options, " ")),
                                    name_of(record.outcome),
                                    text_of(record.exit_code),
                                    text_of(record.signal),
                                    std::to_string(record.attempts),
                                    fmt::format("{:.3f}", record.seconds),
                                    std::to_string(record.peak_memory_bytes)};
  cells.resize(cells.size() + 7);
  if (record.numbers) {
    const JobNumbers& numbers = *record.numbers;
    const std::string values[] = {numbers.orbifold,
                                  fmt::format("{}", fmt::join(numbers.cones, ",")),
                                  std::to_string(numbers.vertices),
                                  std::to_string(numbers.faces),
                                  cell_of(numbers.sigma),
                                  cell_of(numbers.within_4),
                                  cell_of(numbers.below_64)};
    std::copy(std::begin(values), std::end(values), cells.end() - 7);
  }
  cells.push_back(record.message);
  return cells;
}

}  // namespace

bool is_worth_another_try(JobOutcome outcome) {
  return outcome == JobOutcome::file_trouble || outcome == JobOutcome::out_of_memory ||
         outcome == JobOutcome::out_of_time || outcome == JobOutcome::crashed;
}

bool is_embedded(JobOutcome outcome) {
  return outcome == JobOutcome::certified || outcome == JobOutcome::not_converged ||
         outcome == JobOutcome::not_certified;
}

JobNumbers numbers_of_report(std::string_view report) {
  try {
    const auto json = RecordJson::parse(report);
    JobNumbers numbers;
    numbers.orbifold = json.at("orbifold").at("signature").get<std::string>();
    for (const RecordJson& cone : json.at("cones")) numbers.cones.push_back(cone.at("vertex").get<int>());
    numbers.vertices = json.at("mesh").at("vertices").get<int>();
    numbers.faces = json.at("mesh").at("faces").get<int>();
    const RecordJson& distortion = json.at("distortion");
    numbers.sigma = number_of(distortion.at("sigma"));
    numbers.within_4 = number_of(distortion.at("within_4"));
    numbers.below_64 = number_of(distortion.at("below_64"));
    return numbers;
  } catch (const RecordJson::exception& error) {
    throw MeshError(fmt::format("the report of a job makes no sense: {}", error.what()));
  }
}

std::string record_line(const JobRecord& record) {
  RecordJson json = {{"job", record.job},
                     {"name", record.name},
                     {"mesh", record.mesh},
                     {"options", record.options},
                     {"outcome", name_of(record.outcome)},
                     {"exit_code", optional_json(record.exit_code)},
                     {"signal", optional_json(record.signal)},
                     {"attempts", record.attempts},
                     {"seconds", record.seconds},
                     {"peak_memory_bytes", record.peak_memory_bytes},
                     {"message", record.message},
                     {"warnings", record.warnings}};
  if (record.numbers) json["numbers"] = numbers_json(*record.numbers);
  // Names of files need not be UTF-8.
  return json.dump(-1, ' ', false, RecordJson::error_handler_t::replace) + "\n";
}

std::vector<JobRecord> parse_records(std::string_view lines) {
  std::vector<JobRecord> records;
  int number = 0;
  for (std::size_t end = 0; (end = lines.find('\n')) != std::string_view::npos;
       lines.remove_prefix(end + 1)) {
    ++number;
    try {
      records.push_back(record_from(RecordJson::parse(lines.substr(0, end))));
    } catch (const std::exception& error) {
      throw MeshError(fmt::format("line {} is no record of a job: {}", number, error.what()));
    }
  }
  return records;
}

std::string summary_csv(const std::vector<JobRecord>& records) {
  std::string text =
      "job,name,mesh,options,outcome,exit_code,signal,attempts,seconds,peak_memory_bytes,orbifold,cones,"
      "vertices,"
      "faces,sigma,within_4,below_64,message\n";
  for (const JobRecord& record : records) {
    const std::vector<std::string> cells = summary_cells(record);
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (k > 0) text += ',';
      text += csv_cell(cells[k]);
    }
    text += '\n';
  }
  return text;
}

}  // namespace orbitutte
