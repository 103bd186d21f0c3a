#pragma once

#include <string_view>

#include "base/params.h"

namespace piperun::acoustics {

/// Sets one number of a parameter struct by name and remembers its range.
class SetNumber : public ParamVisitor {
 public:
  SetNumber(std::string_view name, double value) : name_(name), value_(value) {}
  bool found() const { return found_; }
  const Range& range() const { return range_; }

  void Number(const ParamInfo& info, const Range& range, double& value) override {
    if (info.name != name_) return;
    value = value_;
    range_ = range;
    found_ = true;
  }
  void NumberOr(const ParamInfo&, const Range&, std::string_view, std::optional<double>&) override {}
  void Integer(const ParamInfo&, std::int64_t, std::int64_t, std::int64_t&) override {}
  void Flag(const ParamInfo&, bool&) override {}
  void Text(const ParamInfo&, std::string&) override {}
  void Choice(const ParamInfo&, std::span<const std::string_view>, std::string&) override {}
  void Array(const ParamInfo&, const Range&, std::span<double>) override {}
  void Table(const ParamInfo&, const Range&, std::size_t, std::vector<double>&) override {}
  void Group(const ParamInfo&, const std::function<void(ParamVisitor&)>&) override {}
  void List(const ParamInfo&, ParamList&) override {}
  void Map(const ParamInfo&, ParamMap&) override {}

 private:
  std::string_view name_;
  double value_;
  Range range_;
  bool found_ = false;
};

}  // namespace piperun::acoustics
