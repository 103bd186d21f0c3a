#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace piperun::sim {

enum class InpSection {
  kTitle,
  kJunctions,
  kReservoirs,
  kTanks,
  kPipes,
  kPumps,
  kValves,
  kTags,
  kDemands,
  kStatus,
  kPatterns,
  kCurves,
  kControls,
  kRules,
  kEnergy,
  kEmitters,
  kLeakage,
  kQuality,
  kSources,
  kReactions,
  kMixing,
  kTimes,
  kReport,
  kOptions,
  kCoordinates,
  kVertices,
  kLabels,
  kBackdrop,
  kRoughness,
};
inline constexpr std::size_t kInpSectionCount = 29;

/// A line of an .inp file that holds something, taken apart. Knows where it stands, so that an error about it
/// can say so.
struct InpLine {
  std::string_view file;  ///< name of the file, for messages
  InpSection section = InpSection::kTitle;
  int number = 0;
  std::vector<std::string> words;
  std::string comment;  ///< what follows the semicolon

  std::size_t size() const { return words.size(); }
  const std::string& operator[](std::size_t i) const { return words[i]; }
  /// Throws InputError: "FILE:12: [PIPES] 'P7': PROBLEM".
  [[noreturn]] void Fail(const std::string& problem) const;
  /// Fails unless there are at least `n` words.
  void RequireWords(std::size_t n, const char* layout) const;
};

struct InpSections {
  std::array<std::vector<InpLine>, kInpSectionCount> lines;
  bool has_end = false;  ///< [END] was there: the file is whole
};

/// A text cut into its sections (in any order, each as often as it likes, up to [END]), lines without
/// comments. Latin-1 becomes UTF-8. Throws InputError for bytes that no text has, text before the first
/// section, an unknown section, a heading cut short.
InpSections SplitInp(std::string_view text, std::string_view name);

const char* SectionName(InpSection section);

/// EPANET's way with keywords: `word` begins with `keyword`, in upper or lower case.
bool BeginsWith(std::string_view word, std::string_view keyword);

}  // namespace piperun::sim
