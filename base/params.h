#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/pose.h"

namespace piperun {

/// Allowed values of a number: from `min` to `max`, each end included unless it is said to be open.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false;
  bool max_open = false;

  bool Contains(double x) const { return (min_open ? x > min : x >= min) && (max_open ? x < max : x <= max); }
  /// "[0, 1)", "> 0", ">= 0", "any number".
  std::string Text() const;

  static Range Any() { return {}; }
  static Range Positive() { return {.min = 0, .min_open = true}; }
  static Range NonNegative() { return {.min = 0}; }
  static Range Between(double low, double high) { return {.min = low, .max = high}; }
};

/// What a field is called (snake_case, with its unit as suffix) and one sentence about it.
struct ParamInfo {
  std::string_view name;
  std::string_view doc;
  bool required = false;  ///< the file must give it: there is no default
};

class ParamVisitor;

/// A list of structs with a variable length, behind a face that a visitor can walk and resize.
class ParamList {
 public:
  virtual ~ParamList() = default;
  virtual std::size_t size() const = 0;
  virtual void Resize(std::size_t n) = 0;
  virtual void VisitItem(std::size_t i, ParamVisitor& v) = 0;
};

/// The same for structs that are found by a name of the user's own ("imu0").
class ParamMap {
 public:
  virtual ~ParamMap() = default;
  virtual std::vector<std::string> Names() const = 0;
  virtual void Clear() = 0;
  virtual void Add(const std::string& name) = 0;
  virtual void VisitItem(std::size_t i, ParamVisitor& v) = 0;
};

/// A parameter struct lists its fields once, in `void Visit(ParamVisitor&)`, and every reader, writer,
/// reference page and perturber is a visitor. The value a default-constructed struct holds is the default.
class ParamVisitor {
 public:
  virtual ~ParamVisitor() = default;

  virtual void Number(const ParamInfo& info, const Range& range, double& value) = 0;
  /// A number, or the word `none` ("unknown", "automatic").
  virtual void NumberOr(const ParamInfo& info, const Range& range, std::string_view none,
                        std::optional<double>& value) = 0;
  virtual void Integer(const ParamInfo& info, std::int64_t min, std::int64_t max, std::int64_t& value) = 0;
  virtual void Flag(const ParamInfo& info, bool& value) = 0;
  virtual void Text(const ParamInfo& info, std::string& value) = 0;
  virtual void Choice(const ParamInfo& info, std::span<const std::string_view> allowed,
                      std::string& value) = 0;
  /// A row of exactly values.size() numbers.
  virtual void Array(const ParamInfo& info, const Range& range, std::span<double> values) = 0;
  /// Any number of rows of `columns` numbers each, stored row after row.
  virtual void Table(const ParamInfo& info, const Range& range, std::size_t columns,
                     std::vector<double>& values) = 0;
  virtual void Group(const ParamInfo& info, const std::function<void(ParamVisitor&)>& visit) = 0;
  virtual void List(const ParamInfo& info, ParamList& list) = 0;
  virtual void Map(const ParamInfo& info, ParamMap& map) = 0;

  void Vector(const ParamInfo& info, const Range& range, Vector3d& value) {
    Array(info, range, std::span<double>(value.data(), 3));
  }
  /// Nine numbers, row by row.
  void Matrix(const ParamInfo& info, const Range& range, Matrix3d& value);
  template <class T>
  void Struct(const ParamInfo& info, T& value) {
    Group(info, [&value](ParamVisitor& v) { value.Visit(v); });
  }
  /// A list of structs with Visit.
  template <class T>
  void Items(const ParamInfo& info, std::vector<T>& items);
  /// Structs with `std::string name` and Visit, by name.
  template <class T>
  void NamedItems(const ParamInfo& info, std::vector<T>& items);
};

/// Base of every kind's parameters.
class Params {
 public:
  virtual ~Params() = default;
  virtual void Visit(ParamVisitor& v) = 0;
  virtual std::unique_ptr<Params> Clone() const = 0;
};

/// `struct ImuParams : ParamsOf<ImuParams> { ... void Visit(ParamVisitor&) override; };`
template <class Derived>
class ParamsOf : public Params {
 public:
  std::unique_ptr<Params> Clone() const override {
    return std::make_unique<Derived>(static_cast<const Derived&>(*this));
  }
};

template <class Derived>
std::unique_ptr<Params> MakeParams() {
  return std::make_unique<Derived>();
}

/// ParamList over a vector of structs with Visit.
template <class T>
class VectorParamList : public ParamList {
 public:
  explicit VectorParamList(std::vector<T>& items) : items_(items) {}
  std::size_t size() const override { return items_.size(); }
  void Resize(std::size_t n) override { items_.resize(n); }
  void VisitItem(std::size_t i, ParamVisitor& v) override { items_[i].Visit(v); }

 private:
  std::vector<T>& items_;
};

/// ParamMap over a vector of structs with `std::string name` and Visit; keeps the order of the file.
template <class T>
class VectorParamMap : public ParamMap {
 public:
  explicit VectorParamMap(std::vector<T>& items) : items_(items) {}
  std::vector<std::string> Names() const override {
    std::vector<std::string> names;
    for (const T& item : items_) names.push_back(item.name);
    return names;
  }
  void Clear() override { items_.clear(); }
  void Add(const std::string& name) override { items_.emplace_back().name = name; }
  void VisitItem(std::size_t i, ParamVisitor& v) override { items_[i].Visit(v); }

 private:
  std::vector<T>& items_;
};

template <class T>
void ParamVisitor::Items(const ParamInfo& info, std::vector<T>& items) {
  VectorParamList<T> list(items);
  List(info, list);
}

template <class T>
void ParamVisitor::NamedItems(const ParamInfo& info, std::vector<T>& items) {
  VectorParamMap<T> map(items);
  Map(info, map);
}

}  // namespace piperun
