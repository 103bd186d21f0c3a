#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "base/params.h"

namespace piperun::testing {

using ParamValue = std::variant<double, bool, std::string, std::vector<double>>;
using ParamValues = std::map<std::string, ParamValue>;

/// Writes values into a parameter struct by key path, as the YAML reader does. A value out of range, of the
/// wrong type or for an unknown key fails the test.
class ParamWriter : public ParamVisitor {
 public:
  explicit ParamWriter(ParamValues values) : values_(std::move(values)) {}
  ~ParamWriter() override {
    for (const auto& [key, value] : values_) ADD_FAILURE() << "no such parameter: " << key;
  }

  void Number(const ParamInfo& info, const Range& range, double& value) override {
    Take<double>(info, [&](double x) { Check(info, range, value = x); });
  }
  void NumberOr(const ParamInfo& info, const Range& range, std::string_view,
                std::optional<double>& value) override {
    Take<double>(info, [&](double x) { Check(info, range, (value = x).value()); });
  }
  void Integer(const ParamInfo& info, std::int64_t min, std::int64_t max, std::int64_t& value) override {
    Take<double>(info, [&](double x) {
      value = static_cast<std::int64_t>(x);
      EXPECT_TRUE(value >= min && value <= max) << info.name << " = " << value;
    });
  }
  void Flag(const ParamInfo& info, bool& value) override {
    Take<bool>(info, [&](bool x) { value = x; });
  }
  void Text(const ParamInfo& info, std::string& value) override {
    Take<std::string>(info, [&](const std::string& x) { value = x; });
  }
  void Choice(const ParamInfo& info, std::span<const std::string_view> allowed, std::string& value) override {
    Text(info, value);
    EXPECT_NE(std::find(allowed.begin(), allowed.end(), value), allowed.end()) << value;
  }
  void Array(const ParamInfo& info, const Range& range, std::span<double> values) override {
    Take<std::vector<double>>(info, [&](const std::vector<double>& x) {
      ASSERT_EQ(x.size(), values.size()) << info.name;
      for (std::size_t i = 0; i < x.size(); ++i) Check(info, range, values[i] = x[i]);
    });
  }
  void Table(const ParamInfo& info, const Range&, std::size_t columns, std::vector<double>& values) override {
    Take<std::vector<double>>(info, [&](const std::vector<double>& x) {
      ASSERT_EQ(x.size() % columns, 0U) << info.name;
      values = x;
    });
  }
  void Group(const ParamInfo& info, const std::function<void(ParamVisitor&)>& visit) override {
    const std::string outer = prefix_;
    prefix_ += std::string(info.name) + ".";
    visit(*this);
    prefix_ = outer;
  }
  void List(const ParamInfo&, ParamList&) override {}
  void Map(const ParamInfo&, ParamMap&) override {}

 private:
  template <class T, class Use>
  void Take(const ParamInfo& info, const Use& use) {
    const auto found = values_.find(prefix_ + std::string(info.name));
    if (found == values_.end()) return;
    if (const T* value = std::get_if<T>(&found->second)) {
      use(*value);
    } else {
      ADD_FAILURE() << "wrong type for " << found->first;
    }
    values_.erase(found);
  }
  static void Check(const ParamInfo& info, const Range& range, double x) {
    EXPECT_TRUE(range.Contains(x)) << info.name << " = " << x << ", allowed " << range.Text();
  }

  ParamValues values_;
  std::string prefix_;
};

/// Fresh parameters of a kind with some values changed.
template <class Kind>
std::unique_ptr<Params> MakeParamsOf(const Kind& kind, ParamValues values) {
  auto params = kind.make_params();
  ParamWriter writer(std::move(values));
  params->Visit(writer);
  return params;
}

/// The kind of this name.
template <class Kind>
const Kind& FindKind(const std::vector<Kind>& kinds, std::string_view name) {
  const auto found = std::find_if(kinds.begin(), kinds.end(), [&](const Kind& k) { return k.name == name; });
  if (found == kinds.end()) throw std::runtime_error("no such kind: " + std::string(name));
  return *found;
}

}  // namespace piperun::testing
