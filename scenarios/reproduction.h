#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace piperun::scenarios {

struct ReproduceOptions {
  double size = 1;  ///< 1: as published; 0.01: a hundredth of the runs, with bounds as much wider
  int jobs = 0;     ///< threads, whole runs each; 0: all cores
  std::uint64_t seed = 1;
  std::filesystem::path out{};  ///< folder for what the study draws; empty: nothing is drawn
  const std::atomic<bool>* stop = nullptr;
  std::function<void(double fraction, const std::string& note)> progress;
};

/// One figure held against what is expected of it.
struct ReproducedFigure {
  std::string what;
  std::string measured;
  std::string expected;
  bool passed = false;
  std::string source{};  ///< of what is expected; may be empty
};

struct ReproducedTable {
  std::string title;
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;
};

struct ReproduceReport {
  std::vector<ReproducedTable> tables;
  std::vector<ReproducedFigure> figures;

  bool passed() const;
};

/// A study that can be run again by anybody: `piperun reproduce NAME`. Deterministic in seed and size,
/// whatever the number of jobs.
struct Reproduction {
  std::string_view name;
  std::string_view doc;
  ReproduceReport (*run)(const ReproduceOptions& options);
  bool draws = false;  ///< it has something to put into ReproduceOptions::out
};

/// Generated from scenarios/reproductions/*.cc.
const std::vector<Reproduction>& Reproductions();

std::string WriteReproduceJson(const Reproduction& reproduction, const ReproduceReport& report);

}  // namespace piperun::scenarios
