#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "base/params.h"

namespace piperun::scenarios {

using VisitFunction = std::function<void(ParamVisitor&)>;

/// "file:line" of every key path a reader has met; asked for by cross-checks that come after reading.
class SourceMap {
 public:
  void Add(const std::string& key_path, std::string where) { where_[key_path] = std::move(where); }
  /// Of the path itself, or of the longest part of it that is known; empty when none is.
  std::string Find(std::string key_path) const;

 private:
  std::map<std::string, std::string> where_;
};

/// A strict YAML file. Reading it into parameter structs refuses unknown keys (and names the nearest known
/// one), keys given twice, wrong types, missing required keys and values out of range, each with file, line,
/// key path, value and allowed range. A number's key may be spelt with another unit of the same quantity
/// (radius_mm for radius_m, rate_deg_s for rate_rad_s); it is converted once, here.
class YamlDocument {
 public:
  /// `name` stands in messages. Throws InputError when the text is not YAML or not a map at the top.
  YamlDocument(const std::string& text, std::string name);
  /// Throws InputError when the file cannot be read.
  static YamlDocument FromFile(const std::string& path);
  ~YamlDocument();
  YamlDocument(YamlDocument&&) noexcept;
  YamlDocument& operator=(YamlDocument&&) noexcept;

  /// Overrides one value, "sensors.imu0.rate_Hz=200". Items of lists are named by index ("leaks[0]") or by
  /// their id ("leaks.L1.s_m"). The value is YAML. Throws InputError for a malformed assignment.
  void Set(const std::string& assignment);

  /// Fills the structs that `visit` walks. One that itself refuses a value it read throws InputError with the
  /// value's key; the key's path and its place in the file are added here.
  void Read(const VisitFunction& visit, SourceMap* sources = nullptr) const;
  /// The same, but other keys may stand beside those that `visit` asks for.
  void ReadSome(const VisitFunction& visit) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The structs that `visit` walks as YAML, every field written, numbers in shortest round-trip decimals.
std::string WriteYaml(const VisitFunction& visit);

}  // namespace piperun::scenarios
