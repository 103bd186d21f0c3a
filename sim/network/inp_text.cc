#include "sim/network/inp_text.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "base/check.h"

namespace piperun::sim {
namespace {

constexpr std::array<const char*, kInpSectionCount> kNames{
    "[TITLE]",       "[JUNCTIONS]", "[RESERVOIRS]", "[TANKS]",    "[PIPES]",    "[PUMPS]",
    "[VALVES]",      "[TAGS]",      "[DEMANDS]",    "[STATUS]",   "[PATTERNS]", "[CURVES]",
    "[CONTROLS]",    "[RULES]",     "[ENERGY]",     "[EMITTERS]", "[LEAKAGE]",  "[QUALITY]",
    "[SOURCES]",     "[REACTIONS]", "[MIXING]",     "[TIMES]",    "[REPORT]",   "[OPTIONS]",
    "[COORDINATES]", "[VERTICES]",  "[LABELS]",     "[BACKDROP]", "[ROUGHNESS]"};
constexpr std::size_t kLeastHeading = 4;  // "[TIT": headings may be cut, as in "[COORD]"

char Upper(char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; }

bool IsSpace(char c) { return c == ' ' || c == '\t' || c == '\f' || c == '\v'; }

/// Bytes that follow a UTF-8 lead byte, or nothing when `c` cannot lead.
std::optional<int> FollowerCount(unsigned char c) {
  if (c < 0x80) return 0;
  if (c >= 0xC2 && c <= 0xDF) return 1;
  if (c >= 0xE0 && c <= 0xEF) return 2;
  if (c >= 0xF0 && c <= 0xF4) return 3;
  return std::nullopt;
}

bool IsUtf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto followers = FollowerCount(static_cast<unsigned char>(text[i]));
    if (!followers) return false;
    for (int k = 0; k < *followers; ++k) {
      if (++i == text.size() || (static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) return false;
    }
  }
  return true;
}

std::string FromLatin1(std::string_view line) {
  std::string utf8;
  for (const char c : line) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80) {
      utf8.push_back(c);
    } else {
      utf8.push_back(static_cast<char>(0xC0 | (byte >> 6)));
      utf8.push_back(static_cast<char>(0x80 | (byte & 0x3F)));
    }
  }
  return utf8;
}

[[noreturn]] void FailAt(std::string_view name, int number, const std::string& problem) {
  throw InputError(problem, {}, std::string(name) + ":" + std::to_string(number));
}

void RequireText(std::string_view line, std::string_view name, int number) {
  for (const char c : line) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 && !IsSpace(c)) {
      FailAt(name, number,
             "this is not an EPANET input file: byte " + std::to_string(byte) +
                 " does not occur in text; give a .inp file as EPANET exports it");
    }
  }
}

/// Takes the next word off the front of `rest`; a word in double quotes may hold spaces. Empty at the end.
std::string_view TakeWord(std::string_view& rest) {
  while (!rest.empty() && IsSpace(rest.front())) rest.remove_prefix(1);
  if (rest.empty()) return {};
  std::size_t end = 0;
  if (rest.front() == '"') {
    rest.remove_prefix(1);
    end = std::min(rest.find('"'), rest.size());
    const std::string_view word = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    return word.empty() ? TakeWord(rest) : word;
  }
  while (end < rest.size() && !IsSpace(rest[end])) ++end;
  const std::string_view word = rest.substr(0, end);
  rest.remove_prefix(end);
  return word;
}

std::string_view Trim(std::string_view text) {
  while (!text.empty() && IsSpace(text.front())) text.remove_prefix(1);
  while (!text.empty() && IsSpace(text.back())) text.remove_suffix(1);
  return text;
}

/// The section of a heading like "[PIPES]", nothing for [END].
std::optional<InpSection> FindSection(std::string_view heading, std::string_view name, int number) {
  if (BeginsWith(heading, "[END")) return std::nullopt;
  const std::string_view stem = heading.substr(0, heading.find(']'));
  for (std::size_t i = 0; stem.size() >= kLeastHeading && i < kInpSectionCount; ++i) {
    if (BeginsWith(kNames[i], stem)) {
      return static_cast<InpSection>(i);
    }
  }
  FailAt(name, number,
         "unknown section '" + std::string(heading.substr(0, 40)) +
             "'; sections are those of EPANET 2.3, [JUNCTIONS], [PIPES], [OPTIONS] ...");
}

/// Reads line after line into its section.
class Splitter {
 public:
  explicit Splitter(std::string_view name) : name_(name) {}

  /// False at [END].
  bool Add(std::string_view line) {
    ++number_;
    RequireText(line, name_, number_);
    const std::string_view trimmed = Trim(line);
    if (trimmed.empty()) return true;
    if (trimmed.front() == '[') return Enter(trimmed);
    if (trimmed.front() == ';') return true;
    if (!section_) {
      FailAt(name_, number_,
             "text before the first section; an EPANET input file begins with a section like "
             "[TITLE] or [JUNCTIONS]");
    }
    AddWords(line);
    return true;
  }

  InpSections Take() { return std::move(sections_); }

 private:
  bool Enter(std::string_view heading) {
    section_ = FindSection(heading, name_, number_);
    sections_.has_end = !section_.has_value();
    return !sections_.has_end;
  }

  void AddWords(std::string_view line) {
    InpLine result{.file = name_, .section = *section_, .number = number_, .words = {}, .comment = {}};
    if (*section_ == InpSection::kTitle) {
      result.words.emplace_back(line);
    } else {
      const std::size_t semicolon = std::min(line.find(';'), line.size());
      std::string_view rest = line.substr(0, semicolon);
      for (auto word = TakeWord(rest); !word.empty(); word = TakeWord(rest)) result.words.emplace_back(word);
      if (semicolon < line.size()) result.comment = Trim(line.substr(semicolon + 1));
    }
    if (!result.words.empty())
      sections_.lines[static_cast<std::size_t>(*section_)].push_back(std::move(result));
  }

  std::string_view name_;
  int number_ = 0;
  std::optional<InpSection> section_;
  InpSections sections_;
};

}  // namespace

void InpLine::Fail(const std::string& problem) const {
  std::string subject = SectionName(section);
  if (!words.empty() && section != InpSection::kTitle) subject += " '" + words[0].substr(0, 40) + "'";
  throw InputError(problem, subject, std::string(file) + ":" + std::to_string(number));
}

void InpLine::RequireWords(std::size_t n, const char* layout) const {
  if (words.size() >= n) return;
  Fail("the line has " + std::to_string(words.size()) + " of at least " + std::to_string(n) +
       " entries; it reads: " + layout);
}

const char* SectionName(InpSection section) { return kNames[static_cast<std::size_t>(section)]; }

bool BeginsWith(std::string_view word, std::string_view keyword) {
  return word.size() >= keyword.size() && std::equal(keyword.begin(), keyword.end(), word.begin(),
                                                     [](char a, char b) { return Upper(a) == Upper(b); });
}

InpSections SplitInp(std::string_view text, std::string_view name) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const bool utf8 = IsUtf8(text);
  Splitter splitter(name);
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line == "\x1A") break;  // end of file as DOS wrote it
    if (!(utf8 ? splitter.Add(line) : splitter.Add(FromLatin1(line)))) break;
  }
  return splitter.Take();
}

}  // namespace piperun::sim
