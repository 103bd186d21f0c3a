#include <array>
#include <cmath>

#include "sim/network/inp_draft.h"

namespace piperun::sim {
namespace {

using Quantity = RulePremise::Quantity;
using Relation = RulePremise::Relation;
using Subject = RulePremise::Subject;

constexpr double kRelativeTolerance = 1e-3;  // of the file's unit

struct QuantityWord {
  const char* word;
  Quantity quantity;
  Subject subject;
};
constexpr std::array<QuantityWord, 12> kQuantities{{{"DEMAND", Quantity::kDemand, Subject::kNode},
                                                    {"HEAD", Quantity::kHead, Subject::kNode},
                                                    {"GRADE", Quantity::kHead, Subject::kNode},
                                                    {"LEVEL", Quantity::kLevel, Subject::kNode},
                                                    {"PRESSURE", Quantity::kPressure, Subject::kNode},
                                                    {"FILLTIME", Quantity::kFillTime, Subject::kNode},
                                                    {"DRAINTIME", Quantity::kDrainTime, Subject::kNode},
                                                    {"FLOW", Quantity::kFlow, Subject::kLink},
                                                    {"STATUS", Quantity::kStatus, Subject::kLink},
                                                    {"SETTING", Quantity::kSetting, Subject::kLink},
                                                    {"TIME", Quantity::kTime, Subject::kSystem},
                                                    {"CLOCKTIME", Quantity::kClockTime, Subject::kSystem}}};

Subject ReadSubject(const InpLine& line) {
  for (const char* word : {"NODE", "JUNC", "RESER", "TANK"}) {
    if (BeginsWith(line[1], word)) return Subject::kNode;
  }
  for (const char* word : {"LINK", "PIPE", "PUMP", "VALVE"}) {
    if (BeginsWith(line[1], word)) return Subject::kLink;
  }
  if (BeginsWith(line[1], "SYSTEM")) return Subject::kSystem;
  line.Fail("'" + line[1] +
            "' is no subject of a premise; allowed: NODE, JUNCTION, RESERVOIR, TANK, LINK, PIPE, "
            "PUMP, VALVE, SYSTEM");
}

Quantity ReadQuantity(const InpLine& line, std::size_t word, Subject subject) {
  line.RequireWords(word + 1, "IF object id variable relation value");
  for (const QuantityWord& known : kQuantities) {
    const bool is_system_demand = subject == Subject::kSystem && known.quantity == Quantity::kDemand;
    if (BeginsWith(line[word], known.word) && (known.subject == subject || is_system_demand))
      return known.quantity;
  }
  line.Fail("'" + line[word] + "' is no quantity of a " + line[1]);
}

Relation ReadRelation(const InpLine& line, std::size_t word) {
  line.RequireWords(word + 1, "IF object id variable relation value");
  struct RelationWord {
    const char* word;
    Relation relation;
  };
  constexpr std::array<RelationWord, 10> kRelations{{{"=", Relation::kEqual},
                                                     {"<>", Relation::kNotEqual},
                                                     {"<=", Relation::kLessOrEqual},
                                                     {">=", Relation::kGreaterOrEqual},
                                                     {"<", Relation::kLess},
                                                     {">", Relation::kGreater},
                                                     {"IS", Relation::kEqual},
                                                     {"NOT", Relation::kNotEqual},
                                                     {"BELOW", Relation::kLess},
                                                     {"ABOVE", Relation::kGreater}}};
  for (const RelationWord& known : kRelations) {
    if (BeginsWith(line[word], known.word)) return known.relation;
  }
  line.Fail("'" + line[word] + "' is no relation; allowed: =, <>, <, <=, >, >=, IS, NOT, BELOW, ABOVE");
}

double QuantityUnit(const InpDraft& draft, const RulePremise& premise) {
  switch (premise.quantity) {
    case Quantity::kDemand:
    case Quantity::kFlow:
      return draft.units.flow_m3_s;
    case Quantity::kPressure:
      return draft.units.pressure_m;
    case Quantity::kHead:
    case Quantity::kLevel:
      return draft.units.length_m;
    case Quantity::kSetting:
      return SettingUnit(draft, premise.index);
    default:
      return 1;
  }
}

void ReadValue(const InpLine& line, std::size_t word, InpDraft& draft, RulePremise& premise) {
  line.RequireWords(word + 1, "IF object id variable relation value");
  if (premise.quantity == Quantity::kTime || premise.quantity == Quantity::kClockTime) {
    premise.value = static_cast<double>(ReadTime(line, word));
  } else if (premise.quantity == Quantity::kStatus) {
    const auto status = BeginsWith(line[word], "ACTIVE") ? LinkStatus::kActive : FindStatus(line[word]);
    if (!status) line.Fail("the status is '" + line[word] + "'; allowed: OPEN, CLOSED, ACTIVE");
    premise.status = *status;
  } else {
    const bool is_duration =
        premise.quantity == Quantity::kFillTime || premise.quantity == Quantity::kDrainTime;
    const double unit = QuantityUnit(draft, premise);
    premise.value = ReadNumber(line, word, "value") * (is_duration ? 3600 : unit);
    premise.tolerance = kRelativeTolerance * unit;
  }
}

RulePremise ReadPremise(const InpLine& line, InpDraft& draft) {
  line.RequireWords(5, "IF object id variable relation value, or IF SYSTEM variable relation value");
  RulePremise premise;
  premise.is_alternative = BeginsWith(line[0], "OR");
  premise.subject = ReadSubject(line);
  std::size_t word = 2;
  if (premise.subject == Subject::kNode) premise.index = ReadNode(line, word++, draft);
  if (premise.subject == Subject::kLink) premise.index = ReadLink(line, word++, draft);
  premise.quantity = ReadQuantity(line, word, premise.subject);
  premise.relation = ReadRelation(line, word + 1);
  const bool is_fill = premise.quantity == Quantity::kFillTime || premise.quantity == Quantity::kDrainTime;
  if (is_fill && !draft.IsTank(premise.index)) line.Fail("only a tank has a fill or drain time");
  ReadValue(line, word + 2, draft, premise);
  return premise;
}

/// Reads clause after clause; knows what may follow what.
class RuleReader {
 public:
  explicit RuleReader(InpDraft& draft) : draft_(draft) {}

  void Read(const InpLine& line) {
    if (BeginsWith(line[0], "RULE")) return Begin(line);
    if (part_ == Part::kNone) line.Fail("a clause before the first RULE");
    if (BeginsWith(line[0], "IF")) return Enter(line, Part::kHead, Part::kIf);
    if (BeginsWith(line[0], "THEN")) return Enter(line, Part::kIf, Part::kThen);
    if (BeginsWith(line[0], "ELSE")) return Enter(line, Part::kThen, Part::kElse);
    if (BeginsWith(line[0], "AND") || BeginsWith(line[0], "OR")) return AddClause(line);
    if (BeginsWith(line[0], "PRIO")) return ReadPriority(line);
    if (BeginsWith(line[0], "DISABLED")) return Disable(line);
    line.Fail("'" + line[0] +
              "' begins no clause; allowed: RULE, IF, AND, OR, THEN, ELSE, PRIORITY, DISABLED");
  }

  /// At the end of a rule: it must do something.
  void Finish() const {
    if (part_ == Part::kHead || part_ == Part::kIf)
      heading_->Fail("the rule '" + (*heading_)[1] + "' has no THEN; the file may be cut short");
  }

 private:
  enum class Part { kNone, kHead, kIf, kThen, kElse, kEnd };

  Rule& rule() { return draft_.model.rules.back(); }

  void Begin(const InpLine& line) {
    Finish();
    line.RequireWords(2, "RULE id");
    heading_ = &line;
    draft_.model.rules.push_back({line[1], {}, {}, {}, 0});
    part_ = Part::kHead;
  }

  void Enter(const InpLine& line, Part before, Part part) {
    if (part_ != before)
      line.Fail("'" + line[0] + "' is out of place; a rule reads RULE, IF, THEN, ELSE, PRIORITY");
    part_ = part;
    AddClause(line);
  }

  void AddClause(const InpLine& line) {
    if (part_ == Part::kIf) {
      rule().premises.push_back(ReadPremise(line, draft_));
    } else if ((part_ == Part::kThen || part_ == Part::kElse) && !BeginsWith(line[0], "OR")) {
      line.RequireWords(6, "THEN object id STATUS|SETTING IS value");
      const LinkAction action = ReadLinkAction(line, 2, 5, draft_);
      (part_ == Part::kThen ? rule().then_actions : rule().else_actions).push_back(action);
    } else {
      line.Fail("'" + line[0] + "' is out of place; a rule reads RULE, IF, THEN, ELSE, PRIORITY");
    }
  }

  void ReadPriority(const InpLine& line) {
    if (part_ != Part::kThen && part_ != Part::kElse) line.Fail("PRIORITY must follow THEN or ELSE");
    rule().priority = ReadNumber(line, 1, "priority");
    part_ = Part::kEnd;
  }

  void Disable(const InpLine& line) {
    if (part_ == Part::kHead || part_ == Part::kIf) line.Fail("DISABLED must follow THEN, ELSE or PRIORITY");
    draft_.model.notes.push_back("[RULES] " + rule().id + " is disabled and left out");
    draft_.model.rules.pop_back();
    part_ = Part::kNone;
  }

  InpDraft& draft_;
  const InpLine* heading_ = nullptr;
  Part part_ = Part::kNone;
};

}  // namespace

void ReadRules(const InpSections& sections, InpDraft& draft) {
  RuleReader reader(draft);
  for (const InpLine& line : Lines(sections, InpSection::kRules)) reader.Read(line);
  reader.Finish();
}

}  // namespace piperun::sim
