// SPDX-License-Identifier: MIT
// Many embeddings, each in a process of its own. What is finished stands in the log, so that a batch that was
// ended goes on where it was: docs/batches.md.
#include <fmt/format.h>
#include <glob.h>
#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <deque>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "command_arguments.h"
#include "command_files.h"
#include "commands.h"
#include "embed_columns.h"
#include "job_log.h"
#include "job_process.h"
#include "orbitutte/errors.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/manifest.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/memory.h"
#include "orbitutte/page/batch_page.h"
#include "orbitutte/report/batch_record.h"
#include "run.h"
#include "standard_streams.h"

namespace orbitutte::cli {
namespace {

namespace fs = std::filesystem;

constexpr int largest_try = 2;
constexpr std::size_t longest_list = 10;  // of what is missing

// A job, and what its process does.
struct PreparedJob {
  std::size_t number;
  BatchJob job;
  EmbedArguments embed;
};

// The jobs

bool is_manifest(const std::string& path) {
  std::string ending = fs::path(path).extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending == ".csv" || ending == ".tsv";
}

// The files that a pattern names, sorted; a name without stars and brackets stays as it is.
std::vector<std::string> expanded(const std::string& pattern) {
  std::error_code error;
  if (pattern.find_first_of("*?[") == std::string::npos || fs::exists(pattern, error)) return {pattern};
  glob_t found = {};
  const int trouble = ::glob(pattern.c_str(), 0, nullptr, &found);
  std::vector<std::string> paths(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  ::globfree(&found);
  if (trouble == 0) return paths;
  throw ArgumentError(fmt::format("no file is named as in '{}'; correct the pattern", pattern));
}

struct JobList {
  std::vector<BatchJob> jobs;
  /// To which paths in the jobs are relative.
  std::string folder;
};

JobList jobs_in_manifest(const std::string& path) {
  try {
    return {parse_manifest(read_file(path), embed_columns()), fs::path(path).parent_path().string()};
  } catch (const ArgumentError& error) {
    throw ArgumentError(fmt::format("{}: {}", path, error.what()));
  }
}

JobList listed_jobs(const std::vector<std::string>& inputs) {
  if (inputs.size() == 1 && is_manifest(inputs.front())) return jobs_in_manifest(inputs.front());
  std::vector<std::string> meshes;
  for (const std::string& input : inputs) {
    if (is_manifest(input))
      throw ArgumentError(
          fmt::format("'{}' is a manifest, and stands beside other arguments; give it alone", input));
    const std::vector<std::string> found = expanded(input);
    meshes.insert(meshes.end(), found.begin(), found.end());
  }
  return {jobs_of_meshes(meshes), ""};
}

// "--weights" of "--weights=cotan".
std::string option_name(const std::string& option) { return option.substr(0, option.find('=')); }

// The options of the job, then those of all jobs that it does not give itself.
std::vector<std::string> with_common(std::vector<std::string> options,
                                     const std::vector<std::string>& common) {
  const std::size_t own = options.size();
  for (const std::string& option : common) {
    const auto is_same = [&](const std::string& given) { return option_name(given) == option_name(option); };
    if (std::none_of(options.begin(), options.begin() + static_cast<std::ptrdiff_t>(own), is_same))
      options.push_back(option);
  }
  return options;
}

// Throws the ArgumentError of a job, with the column if one of its options alone is at fault.
EmbedArguments parsed(const BatchJob& job) {
  for (const std::string& option : job.options) try {
      parse_embed(job.mesh, {option});
    } catch (const ArgumentError& error) {
      if (option_name(option) == "--spread") continue;  // means nothing without --polygon
      throw ArgumentError(fmt::format("column '{}': {}", option_name(option).substr(2), error.what()));
    }
  return parse_embed(job.mesh, job.options);
}

EmbedArguments arguments_of(const BatchJob& job, const std::string& folder) {
  EmbedArguments arguments = parsed(job);
  arguments.output = (fs::path(folder) / (job.name + ".ply")).string();
  arguments.report = (fs::path(folder) / (job.name + ".json")).string();
  arguments.threads = 1;
  arguments.quiet = true;
  mesh_format(mesh_input(arguments.mesh, arguments.format));
  require_sound(arguments);
  return arguments;
}

// What cannot be read, each with its reason: the mesh, and files that options name.
std::vector<std::string> unreadable_files(const BatchJob& job, const std::vector<ManifestColumn>& columns) {
  std::vector<std::string> paths = {job.mesh};
  for (const ManifestColumn& column : columns)
    for (const std::string& option : job.options)
      if (column.kind == ManifestColumn::Kind::file && option_name(option) == "--" + column.name)
        paths.push_back(option.substr(option.find('=') + 1));
  std::vector<std::string> unreadable;
  for (const std::string& path : paths)
    if (::access(path.c_str(), R_OK) != 0)
      unreadable.push_back(fmt::format("{}: {}", path, std::strerror(errno)));
  return unreadable;
}

void require_files(const std::vector<std::string>& missing) {
  if (missing.empty()) return;
  std::string list;
  for (std::size_t k = 0; k < std::min(missing.size(), longest_list); ++k)
    list += fmt::format("{}{}", k == 0 ? "" : "; ", missing[k]);
  if (missing.size() > longest_list) list += fmt::format("; and {} more", missing.size() - longest_list);
  throw FileError(
      fmt::format("{} of the files cannot be read, so nothing was run: {}", missing.size(), list));
}

std::vector<PreparedJob> prepared_jobs(const BatchArguments& arguments) {
  const JobList list = listed_jobs(arguments.inputs);
  const std::vector<ManifestColumn> columns = embed_columns();
  const std::string manifest = arguments.inputs.front() + ": ";
  std::vector<PreparedJob> jobs;
  std::vector<std::string> missing;
  jobs.reserve(list.jobs.size());
  for (std::size_t k = 0; k < list.jobs.size(); ++k) {
    BatchJob job = list.jobs[k];
    BatchJob there = in_folder(job, columns, list.folder);
    job.options = with_common(std::move(job.options), arguments.common);
    there.options = with_common(std::move(there.options), arguments.common);
    const std::string place = fmt::format("{}{}", job.line > 0 ? manifest : "", place_of(job, k));
    for (const std::string& file : unreadable_files(there, columns))
      missing.push_back(fmt::format("{}: {}", place, file));
    if (!missing.empty()) continue;
    try {
      jobs.push_back({k, job, arguments_of(there, arguments.output)});
    } catch (const ArgumentError& error) {
      throw ArgumentError(fmt::format("{}, {}", place, error.what()));
    }
  }
  require_files(missing);
  return jobs;
}

// The options of the command itself

// Part `index` of `count`.
struct Shard {
  std::size_t index = 0, count = 1;
};

template <typename Value>
bool parse_whole(std::string_view text, Value& value) {
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && stop == text.data() + text.size();
}

Shard parse_shard(const std::string& text) {
  Shard shard;
  if (text.empty()) return shard;
  const std::size_t slash = std::min(text.find('/'), text.size());
  const std::string_view all = text;
  const bool is_sound = slash < text.size() && parse_whole(all.substr(0, slash), shard.index) &&
                        parse_whole(all.substr(slash + 1), shard.count) && shard.index < shard.count;
  if (!is_sound)
    throw ArgumentError(fmt::format(
        "--shard is '{}'; give the part, counted from 0, and how many there are, as in 0/10 .. 9/10", text));
  return shard;
}

std::optional<double> parse_bytes(const std::string& text) {
  if (text.empty()) return std::nullopt;
  double value = 0;
  const std::map<char, double> units = {{'K', 1e3}, {'M', 1e6}, {'G', 1e9}, {'T', 1e12}};
  const auto unit = units.find(static_cast<char>(std::toupper(static_cast<unsigned char>(text.back()))));
  if (unit == units.end() || !parse_whole(std::string_view(text).substr(0, text.size() - 1), value) ||
      !(value > 0))
    throw ArgumentError(
        fmt::format("--memory-limit is '{}'; give a number and its unit, as in 800M or 2G", text));
  return value * unit->second;
}

JobLimits limits_of(const BatchArguments& arguments) {
  if (!(arguments.time_limit >= 0)) throw ArgumentError("--time-limit must not be negative");
  JobLimits limits;
  if (arguments.time_limit > 0) limits.seconds = arguments.time_limit;
  limits.bytes = parse_bytes(arguments.memory_limit);
  return limits;
}

std::size_t jobs_at_once(int jobs) {
  if (jobs < 0) throw ArgumentError("--jobs must not be negative");
  return jobs > 0 ? static_cast<std::size_t>(jobs) : std::max(1U, std::thread::hardware_concurrency());
}

// The records

JobOutcome outcome_of(const ProcessEnd& end, const std::string& message) {
  const bool lacks_memory = end.is_out_of_memory || message == memory_ran_out ||
                            end.messages.find("bad_alloc") != std::string::npos;
  if (end.is_out_of_time) return JobOutcome::out_of_time;
  if (!end.exit_code) return lacks_memory ? JobOutcome::out_of_memory : JobOutcome::crashed;
  switch (*end.exit_code) {
    case succeeded:
      return JobOutcome::certified;
    case file_trouble:
      return lacks_memory ? JobOutcome::out_of_memory : JobOutcome::file_trouble;
    case wrong_usage:
      return JobOutcome::wrong_usage;
    case unsuitable_mesh:
      return JobOutcome::unsuitable_mesh;
    case not_converged:
      return JobOutcome::not_converged;
    case not_certified:
      return JobOutcome::not_certified;
    default:
      return JobOutcome::crashed;
  }
}

constexpr std::string_view speaker = "orbitutte: ", warning_word = "warning: ";

// Divides what a process said into warnings and the first other sentence.
void keep_messages(JobRecord& record, std::string_view text) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.starts_with(speaker)) line.remove_prefix(speaker.size());
    if (line.starts_with(warning_word)) {
      record.warnings.emplace_back(line.substr(warning_word.size()));
    } else if (record.message.empty()) {
      record.message = line;
    }
  }
}

// What is said of a process that was ended.
std::string message_of_end(const JobRecord& record, const JobLimits& limits) {
  if (record.outcome == JobOutcome::out_of_time)
    return fmt::format("ended after {:g} s, the limit of --time-limit", limits.seconds.value_or(0));
  if (record.outcome == JobOutcome::out_of_memory && record.signal && limits.bytes)
    return fmt::format("ended with more than {:g} MB, the limit of --memory-limit", *limits.bytes / 1e6);
  if (record.signal)
    return fmt::format("the process was ended by signal {} ({}){}{}", *record.signal,
                       ::strsignal(*record.signal), record.message.empty() ? "" : ": ", record.message);
  return record.message;
}

JobRecord record_of(const PreparedJob& prepared, const ProcessEnd& end, const JobLimits& limits) {
  JobRecord record;
  record.job = prepared.number;
  record.name = prepared.job.name;
  record.mesh = prepared.job.mesh;
  record.options = prepared.job.options;
  record.exit_code = end.exit_code;
  record.signal = end.signal;
  record.seconds = end.seconds;
  record.peak_memory_bytes = end.peak_memory_bytes;
  keep_messages(record, end.messages);
  record.outcome = outcome_of(end, record.message);
  record.message = message_of_end(record, limits);
  if (is_embedded(record.outcome)) record.numbers = numbers_of_report(read_file(prepared.embed.report));
  return record;
}

// Runs jobs

struct Attempt {
  const PreparedJob* job;
  int number = 1;
};

class JobPool {
 public:
  JobPool(std::size_t at_once, const JobLimits& limits) : at_once_(at_once), limits_(limits) {
    use_one_blas_thread();
  }

  // Calls `ended` with the record of each job, in the order in which they end. What may end otherwise if it
  // is run again is run again, once, behind all others.
  template <typename Ended>
  void run(std::deque<Attempt> waiting, const Ended& ended) {
    while (!waiting.empty() || !running_.empty()) {
      start_some(waiting);
      const std::vector<std::pair<Attempt, ProcessEnd>> ends = next_ends();
      start_some(waiting);  // before records are written, which takes a moment
      for (const auto& [attempt, end] : ends) {
        JobRecord record = record_of(*attempt.job, end, limits_);
        record.attempts = attempt.number;
        if (is_worth_another_try(record.outcome) && attempt.number < largest_try) {
          waiting.push_back({attempt.job, attempt.number + 1});
        } else {
          ended(record);
        }
      }
    }
  }

 private:
  struct Running {
    Attempt attempt;
    JobProcess process;
  };

  void start_some(std::deque<Attempt>& waiting) {
    for (; !waiting.empty() && running_.size() < at_once_; waiting.pop_front()) start(waiting.front());
  }

  void start(const Attempt& attempt) {
    const auto work = [embed = &attempt.job->embed] {
      return on_one_thread([&] { return run_guarded([&] { return embed_command(*embed); }); });
    };
    running_.push_back({attempt, JobProcess(work, limits_)});
  }

  std::vector<std::pair<Attempt, ProcessEnd>> next_ends() {
    std::vector<JobProcess*> processes;
    processes.reserve(running_.size());
    for (Running& running : running_) processes.push_back(&running.process);
    wait_for_any(processes);
    std::vector<std::pair<Attempt, ProcessEnd>> ends;
    std::erase_if(running_, [&](Running& running) {
      const std::optional<ProcessEnd> end = running.process.advance();
      if (end) ends.emplace_back(running.attempt, *end);
      return end.has_value();
    });
    return ends;
  }

  std::size_t at_once_;
  const JobLimits& limits_;
  std::vector<Running> running_;
};

// How far a batch is: on a terminal in one line that is written again and again, elsewhere a line now and
// then.
class BatchProgress {
 public:
  BatchProgress(std::size_t count, bool quiet)
      : count_(count), quiet_(quiet), on_terminal_(isatty(STDERR_FILENO) != 0) {}

  void show(const JobRecord& record) {
    ++done_;
    certified_ += record.outcome == JobOutcome::certified;
    if (quiet_) return;
    if (record.outcome != JobOutcome::certified)
      tell("{}{}: {}: {}\n", on_terminal_ ? "\r\033[K" : "", record.name, name_of(record.outcome),
           record.message);
    constexpr double pause = 10;  // seconds
    if (!on_terminal_ && clock_.seconds() < last_ + pause && done_ < count_) return;
    last_ = clock_.seconds();
    tell("{}{} of {} jobs, {} certified, {:.3g} a second{}", on_terminal_ ? "\r\033[K" : "", done_, count_,
         certified_, static_cast<double>(done_) / std::max(clock_.seconds(), 1e-3),
         on_terminal_ && done_ < count_ ? "" : "\n");
  }

 private:
  std::size_t count_, done_ = 0, certified_ = 0;
  bool quiet_, on_terminal_;
  double last_ = 0;
  Stopwatch clock_;
};

// The batch

// The last record of each job, by name.
using Records = std::map<std::string, JobRecord>;

Records records_in(const std::string& folder) {
  Records records;
  for (const std::string& log : logs_in(folder)) try {
      for (JobRecord& record : parse_records(read_file(log))) {
        std::string name = record.name;
        records.insert_or_assign(std::move(name), std::move(record));
      }
    } catch (const MeshError& error) {
      throw FileError(fmt::format("{}: {}; name another folder", log, error.what()));
    }
  return records;
}

// Refuses records of a job that was another one.
void require_same_jobs(const std::vector<PreparedJob>& jobs, const Records& records) {
  for (const PreparedJob& prepared : jobs) {
    const auto found = records.find(prepared.job.name);
    if (found == records.end()) continue;
    const JobRecord& record = found->second;
    if (record.mesh == prepared.job.mesh && record.options == prepared.job.options) continue;
    throw ArgumentError(fmt::format(
        "{}: the folder has the results of a job '{}' with another mesh or other options ({} {}); name "
        "another "
        "folder, or give the job another name",
        place_of(prepared.job, prepared.number), record.name, record.mesh, fmt::join(record.options, " ")));
  }
}

bool is_done(const PreparedJob& prepared, const Records& records, bool again) {
  const auto found = records.find(prepared.job.name);
  return found != records.end() && !(again && is_worth_another_try(found->second.outcome));
}

void print_list(const std::vector<PreparedJob>& jobs, const Records& records, bool again) {
  for (const PreparedJob& prepared : jobs) {
    const nlohmann::ordered_json line = {{"job", prepared.number},
                                         {"name", prepared.job.name},
                                         {"mesh", prepared.job.mesh},
                                         {"options", prepared.job.options},
                                         {"done", is_done(prepared, records, again)}};
    fmt::print("{}\n", line.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
  }
}

// The smallest exit code of the jobs but 0; of a job without one, that of trouble with files.
int exit_code_of(const std::vector<JobRecord>& records) {
  int worst = succeeded;
  for (const JobRecord& record : records) {
    if (record.outcome == JobOutcome::certified) continue;
    const int code =
        is_worth_another_try(record.outcome) ? file_trouble : record.exit_code.value_or(file_trouble);
    worst = worst == succeeded ? code : std::min(worst, code);
  }
  return worst;
}

std::vector<JobRecord> records_of(const std::vector<PreparedJob>& jobs, const Records& records) {
  std::vector<JobRecord> result;
  result.reserve(jobs.size());
  for (const PreparedJob& prepared : jobs) {
    const auto found = records.find(prepared.job.name);
    if (found == records.end()) continue;
    result.push_back(found->second);
    result.back().job = prepared.number;  // rows may have been put in before it
  }
  return result;
}

void tell_counts(const std::vector<JobRecord>& records, const std::string& page) {
  std::map<JobOutcome, int> counts;
  for (const JobRecord& record : records) ++counts[record.outcome];
  std::string text;
  for (const auto& [outcome, count] : counts)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, name_of(outcome));
  tell("{} jobs: {}{}\n", records.size(), text, page.empty() ? "" : "; see " + page);
}

void require_nobody_at_work(const std::string& folder) {
  for (const std::string& log : logs_in(folder))
    if (is_locked(log))
      throw FileError(
          fmt::format("{}: a batch is at work on it; wait for its end, or name another folder", log));
}

std::string page_in(const std::string& folder) { return (fs::path(folder) / "summary.html").string(); }

int run_single(const std::vector<PreparedJob>& jobs, const BatchArguments& arguments) {
  const int job = *arguments.job;
  if (job < 0 || job >= static_cast<int>(jobs.size()))
    throw ArgumentError(fmt::format("--job is {}, but there are {} jobs, counted from 0", job, jobs.size()));
  make_folder(arguments.output);
  const JobLimits limits = limits_of(arguments);
  std::vector<JobRecord> records;
  JobPool(1, limits).run({{&jobs[static_cast<std::size_t>(job)]}}, [&](const JobRecord& record) {
    fmt::print("{}", record_line(record));
    records.push_back(record);
  });
  return exit_code_of(records);
}

// The jobs of one part.
std::vector<PreparedJob> jobs_of(const std::vector<PreparedJob>& jobs, const Shard& shard) {
  std::vector<PreparedJob> part;
  part.reserve(jobs.size() / shard.count + 1);
  for (std::size_t k = shard.index; k < jobs.size(); k += shard.count) part.push_back(jobs[k]);
  return part;
}

void write_summary(const std::vector<JobRecord>& done, std::size_t missing, const std::string& folder) {
  write_file((fs::path(folder) / "summary.csv").string(), summary_csv(done));
  write_file(page_in(folder), batch_page(done, missing));
}

// The log, with all that has to be true before a job may run.
JobLog opened_log(const BatchArguments& arguments, const Shard& shard) {
  make_folder(arguments.output);
  const bool is_whole = arguments.shard.empty();
  if (is_whole) require_nobody_at_work(arguments.output);
  const std::string name =
      is_whole ? "jobs.jsonl" : fmt::format("jobs-{}-of-{}.jsonl", shard.index, shard.count);
  return JobLog((fs::path(arguments.output) / name).string());
}

int run_batch(const std::vector<PreparedJob>& all, const BatchArguments& arguments) {
  const JobLimits limits = limits_of(arguments);
  const std::size_t at_once = jobs_at_once(arguments.jobs);
  const Shard shard = parse_shard(arguments.shard);
  const bool is_whole = arguments.shard.empty();
  JobLog log = opened_log(arguments, shard);
  if (is_whole) remove_leftovers(arguments.output);
  Records records = records_in(arguments.output);
  const std::vector<PreparedJob> jobs = jobs_of(all, shard);
  require_same_jobs(jobs, records);

  std::deque<Attempt> waiting;
  for (const PreparedJob& prepared : jobs)
    if (!is_done(prepared, records, arguments.again)) waiting.push_back({&prepared});
  if (waiting.size() < jobs.size() && !arguments.quiet)
    tell("orbitutte: {} of {} jobs are done already\n", jobs.size() - waiting.size(), jobs.size());
  if (arguments.summary) waiting.clear();
  BatchProgress progress(waiting.size(), arguments.quiet);
  JobPool(at_once, limits).run(std::move(waiting), [&](const JobRecord& record) {
    log.append(record);
    records.insert_or_assign(record.name, record);
    progress.show(record);
  });
  log.sync();

  const std::vector<JobRecord> done = records_of(jobs, records);
  const std::size_t missing = jobs.size() - done.size();
  if (is_whole) remove_leftovers(arguments.output);  // of processes that were ended
  if (is_whole) write_summary(done, missing, arguments.output);
  if (!arguments.quiet) tell_counts(done, is_whole ? page_in(arguments.output) : "");
  return missing > 0 ? file_trouble : exit_code_of(done);
}

}  // namespace

int batch_command(const BatchArguments& arguments) {
  const std::vector<PreparedJob> jobs = prepared_jobs(arguments);
  if (arguments.list) {
    print_list(jobs, records_in(arguments.output), arguments.again);
    return succeeded;
  }
  return arguments.job ? run_single(jobs, arguments) : run_batch(jobs, arguments);
}

}  // namespace orbitutte::cli
