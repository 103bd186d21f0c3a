#include "acoustics/sound_file.h"

#include <sndfile.h>

#include <string>

#include "base/check.h"

namespace piperun::acoustics {

class SoundFile::Impl {
 public:
  explicit Impl(const std::filesystem::path& path) {
    if (!std::filesystem::is_regular_file(path)) throw InputError("there is no such file", "", path.string());
    file_.reset(sf_open(path.c_str(), SFM_READ, &info_));
    if (!file_) throw InputError(std::string("not a sound file: ") + sf_strerror(nullptr), "", path.string());
    if (info_.channels != 1) {
      throw InputError(std::to_string(info_.channels) + " channels; one is allowed: extract the hydrophone's",
                       "", path.string());
    }
    if (info_.frames <= 0) throw InputError("holds no samples", "", path.string());
  }
  double rate_Hz() const { return info_.samplerate; }
  std::int64_t frames() const { return info_.frames; }
  void SeekTo(std::int64_t frame) {
    Demand(sf_seek(file_.get(), frame, SEEK_SET) == frame, "the frame is in the file");
  }
  std::size_t Read(std::span<double> samples) {
    return static_cast<std::size_t>(
        sf_readf_double(file_.get(), samples.data(), static_cast<sf_count_t>(samples.size())));
  }

 private:
  struct Close {
    void operator()(SNDFILE* file) const { sf_close(file); }
  };
  SF_INFO info_{};
  std::unique_ptr<SNDFILE, Close> file_;
};

SoundFile::SoundFile(const std::filesystem::path& path) : impl_(std::make_unique<Impl>(path)) {}
SoundFile::~SoundFile() = default;
SoundFile::SoundFile(SoundFile&&) noexcept = default;

double SoundFile::rate_Hz() const { return impl_->rate_Hz(); }
std::int64_t SoundFile::frames() const { return impl_->frames(); }
void SoundFile::SeekTo(std::int64_t frame) { impl_->SeekTo(frame); }
std::size_t SoundFile::Read(std::span<double> samples) { return impl_->Read(samples); }

}  // namespace piperun::acoustics
