#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/command.h"
#include "app/recorded_motion.h"
#include "app/validators.h"
#include "base/error.h"
#include "base/print.h"
#include "io/output_file.h"

namespace sumogamma {

namespace {

namespace fs = std::filesystem;

struct CompareOptions {
  fs::path a, b, output;
  std::vector<std::string> types;
  std::size_t samples = 200;
};

struct Comparison {
  const MotionMeasureInfo* measure = nullptr;
  std::size_t agents_a = 0, agents_b = 0;
  DistanceEstimate distance;
};

struct FigureInfo {
  const char *name, *label;
  double DistributionDistance::*figure;
};
constexpr FigureInfo kFigures[] = {
    {"hellinger", "Hellinger", &DistributionDistance::hellinger},
    {"jensen_shannon", "Jensen-Shannon", &DistributionDistance::jensen_shannon},
    {"wasserstein", "Wasserstein", &DistributionDistance::wasserstein},
    {"kolmogorov_smirnov", "Kolmogorov-Smirnov", &DistributionDistance::kolmogorov_smirnov}};

MotionSampler sampled(const fs::path& named, const CompareOptions& options) {
  MotionSampler sampler({options.types.begin(), options.types.end()});
  sample_motion(find_motion(named), sampler);
  if (sampler.sampled_agents() == 0)
    throw Error(named.string(),
                options.types.empty() ? "holds no agents" : "holds no agents of these --types");
  return sampler;
}

std::string distances_csv(const std::vector<Comparison>& comparisons) {
  std::string text = "measure,agents_a,agents_b,distance,value,low_95,high_95,chance_95\n";
  for (const Comparison& one : comparisons)
    for (const FigureInfo& info : kFigures) {
      text += fmt::format("{},{},{},{}", one.measure->name, one.agents_a, one.agents_b, info.name);
      const DistanceEstimate& distance = one.distance;
      if (distance.known)
        text += fmt::format(",{:.6f},{:.6f},{:.6f},{:.6f}\n", distance.value.*info.figure,
                            distance.low.*info.figure, distance.high.*info.figure,
                            distance.chance.*info.figure);
      else
        text += ",,,,\n";
    }
  return text;
}

std::string histograms_csv(const MotionSampler& a, const MotionSampler& b) {
  std::string text = "measure,from,to,count_a,count_b\n";
  for (const MotionMeasureInfo& info : motion_measures()) {
    const std::vector<double> of_a = sum_of(a.agents(info.measure), info.bins.count),
                              of_b = sum_of(b.agents(info.measure), info.bins.count);
    for (std::size_t k = 0; k < info.bins.count; ++k) {
      const double from = info.bins.low + static_cast<double>(k) * info.bins.width();
      text += fmt::format("{},{:.4g},{:.4g},{:.0f},{:.0f}\n", info.name, from,
                          from + info.bins.width(), of_a[k], of_b[k]);
    }
  }
  return text;
}

std::string distances_markdown(const std::vector<Comparison>& comparisons) {
  std::string text = "| measure | agents A / B |", rule = "|---|---|";
  for (const FigureInfo& info : kFigures) {
    text += fmt::format(" {} |", info.label);
    rule += "---|";
  }
  text += "\n" + rule + "\n";
  for (const Comparison& one : comparisons) {
    text += fmt::format("| {} [{}] | {} / {} |", one.measure->label, one.measure->unit,
                        one.agents_a, one.agents_b);
    for (const FigureInfo& info : kFigures) {
      const DistanceEstimate& distance = one.distance;
      if (distance.known)
        text += fmt::format(" {:.3f} ({:.3f} to {:.3f}; chance {:.3f}) |",
                            distance.value.*info.figure, distance.low.*info.figure,
                            distance.high.*info.figure, distance.chance.*info.figure);
      else
        text += " no values |";
    }
    text += "\n";
  }
  return text;
}

int compare(const CompareOptions& options, std::uint64_t seed) {
  const MotionSampler a = sampled(options.a, options), b = sampled(options.b, options);
  std::vector<Comparison> comparisons;
  for (const MotionMeasureInfo& info : motion_measures()) {
    const auto &of_a = a.agents(info.measure), &of_b = b.agents(info.measure);
    comparisons.push_back({&info, of_a.size(), of_b.size(),
                           estimate_distance(of_a, of_b, info.bins, options.samples, seed)});
  }
  const std::string table = distances_markdown(comparisons);
  if (!options.output.empty()) {
    make_output_folder(options.output);
    write_file(options.output / "distances.csv", distances_csv(comparisons));
    write_file(options.output / "histograms.csv", histograms_csv(a, b));
    write_file(options.output / "distances.md", table);
  }
  print(stdout, "{}", table);
  return kExitDone;
}

}  // namespace

CommandRunner add_compare_command(CLI::App& parent) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command = parent.add_subcommand(
      "compare", "how far the distributions of two runs, studies or recordings are apart");
  const char* const what =
      "folder of a run, folder with runs below it, FCD file, or recording as `predict` reads";
  command->add_option("A", options->a, what)->required();
  command->add_option("B", options->b, what)->required();
  command->add_option("-o,--output", options->output,
                      "folder for distances.csv, histograms.csv, distances.md");
  command->add_option("--types", options->types, "sample agents of these types alone")
      ->delimiter(',');
  command->add_option("--samples", options->samples, "of the bootstrap")
      ->check(whole_number(20, 100000))
      ->capture_default_str();
  return [options](const CommonOptions& common) { return compare(*options, common.seed); };
}

}  // namespace sumogamma
