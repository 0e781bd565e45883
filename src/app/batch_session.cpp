#include "app/batch_session.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "app/progress.h"
#include "app/run_plan.h"
#include "app/run_session.h"
#include "app/study_folder.h"
#include "base/error.h"
#include "base/number_text.h"
#include "base/print.h"
#include "base/subprocess.h"
#include "io/config.h"
#include "io/output_file.h"
#include "io/output_folder.h"
#include "io/study_file.h"
#include "io/study_page.h"
#include "io/study_plan_file.h"
#include "io/study_results.h"
#include "study/shard.h"
#include "sumo/scenario_input.h"

namespace sumogamma {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
constexpr auto kWait = std::chrono::milliseconds(100);

std::vector<std::string> set_words(const StudyVariant& variant) {
  std::vector<std::string> words;
  for (const StudySetting& setting : variant.set)
    words.push_back(setting.key + "=" + setting.value);
  return words;
}

std::vector<std::string> option_words(const Study& study, const StudyVariant& variant) {
  std::vector<std::string> words = study.options;
  words.insert(words.end(), variant.options.begin(), variant.options.end());
  if (variant.plain) words.insert(words.end(), {"--control", "none"});
  return words;
}

/// Everything that `run` would refuse, before the first run: a study of a night doesn't end at its
/// first minute. Demand is read once a scenario and driver, settings are for each variant.
void require_runnable(const Study& study) {
  for (const StudyScenario& scenario : study.scenarios)
    for (std::size_t i = 0; i < study.variants.size(); ++i) {
      const StudyVariant& variant = study.variants[i];
      const std::string where = "variant '" + variant.name + "'";
      const RunOptions options =
          parse_run_words(where, scenario.path, option_words(study, variant));
      CommonOptions common;
      common.set = set_words(variant);
      const bool first = std::none_of(
          study.variants.begin(), study.variants.begin() + static_cast<std::ptrdiff_t>(i),
          [&](const StudyVariant& other) {
            return other.plain == variant.plain && other.options == variant.options;
          });
      if (first)
        make_plan(options, common);
      else
        read_config(find_scenario(scenario.path).settings, common.set);
    }
}

std::vector<std::string> command_of(const Study& study, const StudyRun& run,
                                    const fs::path& folder) {
  const StudyVariant& variant = study.variants[run.variant];
  std::vector<std::string> words{own_program().string(),
                                 "run",
                                 study.scenarios[run.scenario].path.string(),
                                 "--output",
                                 folder.string(),
                                 "--force",
                                 "--quiet",
                                 "--seed",
                                 std::to_string(run.seed),
                                 "--threads",
                                 std::to_string(study.threads)};
  const std::vector<std::string> options = option_words(study, variant);
  words.insert(words.end(), options.begin(), options.end());
  for (const std::string& setting : set_words(variant)) {
    words.emplace_back("--set");
    words.push_back(setting);
  }
  return words;
}

/// How a run ended and the last thing that it said, in a line, without the study's folder: that
/// may differ between shards.
std::string describe_failure(const ProcessResult& result, double time_limit,
                             const fs::path& folder) {
  std::string text = describe_end(result, time_limit);
  const std::string log = read_file(folder / "log.txt"), own = "sumo-gamma: ";
  std::size_t begin = log.rfind("\n" + own);
  begin = begin != std::string::npos ? begin + 1 : log.rfind(own, 0);
  if (begin != std::string::npos)
    text += ": " + log.substr(begin + own.size(), log.find('\n', begin) - begin - own.size());
  const std::string place = folder.string();
  for (std::size_t at = 0; (at = text.find(place, at)) != std::string::npos;)
    text.replace(at, place.size(), ".");
  return text;
}

/// Runs of a study, several at once. All that is shared is behind one mutex.
class Pool {
 public:
  Pool(const Study& study, fs::path output, unsigned jobs, bool quiet)
      : study_(study), output_(std::move(output)), jobs_(jobs), quiet_(quiet) {}

  /// Until all are done or failed, or the user interrupts. Throws what a worker threw.
  void run_all(std::span<const StudyRun> runs) {
    open_.assign(runs.begin(), runs.end());
    total_ = runs.size();
    done_ = 0;
    std::erase_if(open_, [&](const StudyRun& run) {
      return read_study_run(output_, study_, run).status == RunStatus::Done;
    });
    done_ = found_ = total_ - open_.size();
    start_ = Clock::now();
    std::vector<std::thread> workers;
    const std::size_t count = std::min<std::size_t>(jobs_, open_.size());
    running_ = count;
    for (std::size_t i = 0; i < count; ++i) workers.emplace_back([this] { work(); });
    show_progress();
    for (std::thread& worker : workers) worker.join();
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void work() {
    try {
      while (const std::optional<StudyRun> run = take()) finish(*run);
    } catch (...) {
      const std::scoped_lock lock(mutex_);
      if (!failure_) failure_ = std::current_exception();
    }
    const std::scoped_lock lock(mutex_);
    --running_;
  }

  /// The next run that nobody else is at; those that another batch, or what one that was killed
  /// left behind, is at are waited for.
  std::optional<StudyRun> take() {
    for (;;) {
      {
        const std::scoped_lock lock(mutex_);
        if (open_.empty() || failure_ || interrupted()) return std::nullopt;
        for (std::size_t i = 0; i < open_.size(); ++i) {
          if (is_being_written(output_ / folder_of(study_, open_[i]))) continue;
          const StudyRun run = open_[i];
          open_.erase(open_.begin() + static_cast<std::ptrdiff_t>(i));
          return run;
        }
      }
      std::this_thread::sleep_for(kWait);
    }
  }

  void finish(const StudyRun& run) {
    const fs::path folder = output_ / folder_of(study_, run);
    // somebody else may have ended it meanwhile
    if (read_study_run(output_, study_, run).status != RunStatus::Done) {
      make_output_folder(folder);
      ProcessRequest request;
      request.arguments = command_of(study_, run, folder);
      request.log = folder / "log.txt";
      request.time_limit = study_.time_limit;
      request.should_stop = [this] { return interrupted() || stopping(); };
      const ProcessResult result = run_process(request);
      if (result.stopped) return;
      const bool done = read_study_run(output_, study_, run).status == RunStatus::Done;
      const std::string failure = done ? "" : describe_failure(result, request.time_limit, folder);
      // another batch came between by a moment
      if (failure.find("another run writes into it") != std::string::npos) {
        const std::scoped_lock lock(mutex_);
        open_.push_back(run);
        return;
      }
      note_failure(folder, failure);
    }
    const std::scoped_lock lock(mutex_);
    ++done_;
  }

  bool stopping() {
    const std::scoped_lock lock(mutex_);
    return failure_ != nullptr;
  }

  void show_progress() {
    Progress progress("batch", static_cast<double>(total_), "runs", quiet_);
    for (bool last = false; !last;) {
      std::this_thread::sleep_for(kWait);
      std::size_t done = 0;
      {
        const std::scoped_lock lock(mutex_);
        last = running_ == 0;
        done = done_;
      }
      if (!progress.due()) continue;
      const double passed = std::chrono::duration<double>(Clock::now() - start_).count();
      const double own = static_cast<double>(done - found_);
      std::string detail = fmt::format("{} of {} runs", done, total_);
      if (own > 0)
        detail +=
            fmt::format(", about {:.0f} s left", passed / own * static_cast<double>(total_ - done));
      progress.update(static_cast<double>(done), detail);
    }
  }

  const Study& study_;
  fs::path output_;
  unsigned jobs_;
  bool quiet_;
  Clock::time_point start_{};
  std::mutex mutex_;
  std::deque<StudyRun> open_;
  std::size_t total_ = 0, done_ = 0, found_ = 0, running_ = 0;
  std::exception_ptr failure_;
};

/// Adds runs of other folders: copied under another name first, so that a whole run is there or
/// none.
void gather_shards(const BatchOptions& options, const Study& study,
                   std::span<const StudyRun> runs) {
  for (const fs::path& from : options.from) require_same_study(from, study);
  for (const StudyRun& run : runs) {
    if (read_study_run(options.output, study, run).status == RunStatus::Done) continue;
    for (const fs::path& from : options.from) {
      if (read_study_run(from, study, run).status == RunStatus::Missing) continue;
      const fs::path to = options.output / folder_of(study, run);
      fs::path temporary = to;
      temporary += ".part";
      try {
        fs::create_directories(to.parent_path());
        fs::remove_all(temporary);
        fs::copy(from / folder_of(study, run), temporary, fs::copy_options::recursive);
        fs::remove_all(to);
        fs::rename(temporary, to);
      } catch (const fs::filesystem_error& error) {
        throw Error(to.string(), "can't be written (" + error.code().message() + ")");
      }
      break;
    }
  }
}

/// With those that were added.
std::vector<std::uint64_t> seeds_of(std::span<const StudyRun> runs) {
  std::vector<std::uint64_t> seeds;
  for (const StudyRun& run : runs)
    if (std::find(seeds.begin(), seeds.end(), run.seed) == seeds.end()) seeds.push_back(run.seed);
  return seeds;
}

void require_none_missing(const Study& study, std::span<const StudyRunResult> results) {
  const auto missing = [](const StudyRunResult& one) { return one.status == RunStatus::Missing; };
  const auto first = std::find_if(results.begin(), results.end(), missing);
  if (first == results.end()) return;
  throw Error("--merge", std::to_string(std::count_if(results.begin(), results.end(), missing)) +
                             " of " + std::to_string(results.size()) +
                             " runs are missing, the first is " +
                             folder_of(study, first->run).string() +
                             "; run their shards, and name the folders behind --from");
}

/// Writes the results; returns the exit code.
int conclude(const Study& study, const fs::path& output, std::span<const StudyRunResult> results) {
  const std::vector<SummaryRow> rows = summarize(study, results);
  write_study_plan(output, study);
  write_file(output / "runs.csv", runs_csv(study, results));
  write_file(output / "timing.csv", timing_csv(study, results));
  write_file(output / "summary.csv", summary_csv(rows));
  write_study_database(output / "study.sqlite", study, results, rows);
  const std::string table = summary_markdown(study, rows);
  write_file(output / "summary.md", table);
  write_file(output / "report.html", study_html(output, study, results, rows));
  print(stdout, "{}", table);
  std::size_t failed = 0;
  for (const StudyRunResult& result : results) {
    if (result.status != RunStatus::Failed) continue;
    ++failed;
    print(stderr, "sumo-gamma: {}: {}\n",
          (output / folder_of(study, result.run) / "log.txt").string(), result.failure);
  }
  if (failed == 0) return kExitDone;
  print(stderr, "sumo-gamma: {} of {} runs failed, the same command tries them again\n", failed,
        results.size());
  return kExitNotHeld;
}

/// Runs, and adds two seeds at a time while the interval that was asked for is too wide.
std::vector<StudyRun> run_seeds(const Study& study, const BatchOptions& options, const Shard& shard,
                                bool quiet) {
  std::vector<std::uint64_t> seeds = study.seeds;
  const unsigned processors = std::max(1u, std::thread::hardware_concurrency());
  Pool pool(study, options.output, options.jobs > 0 ? options.jobs : processors, quiet);
  for (;;) {
    const std::vector<StudyRun> runs = runs_of(study, seeds);
    pool.run_all(shard_of(runs, shard));
    if (!study.until || interrupted()) return runs;
    const StudyUntil& until = *study.until;
    const std::vector<StudyRunResult> results = read_study_runs(options.output, study, runs);
    if (std::none_of(results.begin(), results.end(), [&](const StudyRunResult& result) {
          return result.numbers.contains(until.measure);
        }))
      throw Error("until " + until.measure, "no run has a figure of that name in results.json");
    const double width = widest_interval(study, results, until);
    if (!quiet)
      print(stderr, "batch: {} seeds, widest interval of {}: {}\n", seeds.size(), until.measure,
            until.relative ? number_text(100.0 * width) + " %" : number_text(width));
    if (width <= until.width) return runs;
    if (seeds.size() >= until.most_seeds) {
      spdlog::warn("{}: still {} wide after {} seeds (most_seeds)", until.measure, width,
                   seeds.size());
      return runs;
    }
    const std::uint64_t last = *std::max_element(seeds.begin(), seeds.end());
    seeds.insert(seeds.end(), {last + 1, last + 2});
  }
}

}  // namespace

int run_batch(const BatchOptions& options, const CommonOptions& common) {
  Study study = read_study(options.study);
  if (!options.until.empty()) study.until = parse_until(options.until);
  const Shard shard = parse_shard(options.shard);
  const bool is_part = !options.shard.empty();
  if (study.until && (is_part || options.merge))
    throw Error("--until",
                "a part of a study doesn't know the others' intervals: leave --shard "
                "and --merge out");
  if (options.merge && is_part) throw Error("--merge", "is for all shards, leave --shard out");
  if (!options.from.empty() && !options.merge) throw Error("--from", "goes with --merge");
  require_runnable(study);
  claim_study_folder(options.output, study);
  std::vector<StudyRun> runs = runs_of(study, study.seeds);
  if (options.merge)
    gather_shards(options, study, runs);
  else
    runs = run_seeds(study, options, shard, common.quiet);
  if (interrupted()) {
    print(stderr, "sumo-gamma: interrupted; the same command goes on\n");
    return kExitInterrupted;
  }
  if (is_part) {
    const std::vector<StudyRunResult> results =
        read_study_runs(options.output, study, shard_of(runs, shard));
    const auto failed = std::count_if(
        results.begin(), results.end(),
        [](const StudyRunResult& result) { return result.status == RunStatus::Failed; });
    print(stdout, "shard {}: {} runs, {} failed; --merge makes the study's results of all shards\n",
          options.shard, results.size(), failed);
    return failed > 0 ? kExitNotHeld : kExitDone;
  }
  study.seeds = seeds_of(runs);
  const std::vector<StudyRunResult> results = read_study_runs(options.output, study, runs);
  if (options.merge) require_none_missing(study, results);
  return conclude(study, options.output, results);
}

}  // namespace sumogamma
