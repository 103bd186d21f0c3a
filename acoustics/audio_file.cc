#include "acoustics/audio_file.h"

#include <fcntl.h>
#include <sndfile.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "base/check.h"

namespace piperun::acoustics {
namespace {

static_assert(sizeof(int) == sizeof(std::int32_t), "libsndfile counts in int");

constexpr std::int64_t kLargestWav_bytes = (std::int64_t{1} << 32) - 4096;  // leaves room for the header

/// A file descriptor behind libsndfile. It remembers the first failed write, which libsndfile itself reports
/// late or, while it completes a header, not at all.
class File {
 public:
  File(const std::filesystem::path& path, int flags) : descriptor_(::open(path.c_str(), flags, 0666)) {}
  ~File() { CloseDescriptor(); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;

  bool open() const { return descriptor_ >= 0; }
  int error() const { return error_; }
  void CloseDescriptor() {
    if (descriptor_ >= 0 && ::close(descriptor_) != 0 && error_ == 0) error_ = errno;
    descriptor_ = -1;
  }

  static SF_VIRTUAL_IO Callbacks() { return {Length, Seek, Read, Write, Tell}; }

 private:
  static int Descriptor(void* self) { return static_cast<File*>(self)->descriptor_; }
  static sf_count_t Tell(void* self) { return ::lseek(Descriptor(self), 0, SEEK_CUR); }
  static sf_count_t Seek(sf_count_t offset, int whence, void* self) {
    return ::lseek(Descriptor(self), offset, whence);
  }
  static sf_count_t Length(void* self) {
    const off_t here = ::lseek(Descriptor(self), 0, SEEK_CUR);
    const off_t end = ::lseek(Descriptor(self), 0, SEEK_END);
    ::lseek(Descriptor(self), here, SEEK_SET);
    return end;
  }
  static sf_count_t Read(void* data, sf_count_t bytes, void* self) {
    return std::max<sf_count_t>(0, ::read(Descriptor(self), data, static_cast<std::size_t>(bytes)));
  }
  static sf_count_t Write(const void* data, sf_count_t bytes, void* self);

  int descriptor_;
  int error_ = 0;
};

sf_count_t File::Write(const void* data, sf_count_t bytes, void* self) {
  auto* file = static_cast<File*>(self);
  const char* next = static_cast<const char*>(data);
  sf_count_t left = bytes;
  while (left > 0 && file->error_ == 0) {
    const ssize_t written = ::write(file->descriptor_, next, static_cast<std::size_t>(left));
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) {
      file->error_ = written < 0 ? errno : EIO;
      break;
    }
    next += written;
    left -= written;
  }
  return bytes - left;
}

struct SndfileCloser {
  void operator()(SNDFILE* file) const { sf_close(file); }
};
using SndfilePtr = std::unique_ptr<SNDFILE, SndfileCloser>;

std::int64_t CalcDataBytes(const AudioFormat& format, std::int64_t frames) {
  return frames * (format.container == AudioContainer::kFloatWav ? 32 : format.bits) / 8;
}

bool NeedsRf64(const AudioFormat& format, std::int64_t frames) {
  return format.container != AudioContainer::kFlac && CalcDataBytes(format, frames) > kLargestWav_bytes;
}

int SndfileFormat(const AudioFormat& format, bool rf64) {
  const int subtype = format.container == AudioContainer::kFloatWav ? SF_FORMAT_FLOAT
                      : format.bits == 16                           ? SF_FORMAT_PCM_16
                                                                    : SF_FORMAT_PCM_24;
  if (format.container == AudioContainer::kFlac) return SF_FORMAT_FLAC | subtype;
  return (rf64 ? SF_FORMAT_RF64 : SF_FORMAT_WAV) | subtype;
}

void RequireFormat(const AudioFormat& format) {
  if (format.bits != 16 && format.bits != 24) {
    throw InputError(std::to_string(format.bits) + " is not allowed; an audio file has 16 or 24 bits",
                     "bits");
  }
  const std::int64_t highest_Hz = format.container == AudioContainer::kFlac ? 655350 : 2000000;
  if (format.rate_Hz < 1 || format.rate_Hz > highest_Hz) {
    throw InputError(std::to_string(format.rate_Hz) + " is not allowed; the range is [1, " +
                         std::to_string(highest_Hz) + "]",
                     "rate_Hz");
  }
}

/// libsndfile left-justifies: a count sits in the upper bits of its int.
std::int32_t PaddingFactor(std::int64_t bits) { return std::int32_t{1} << (32 - bits); }

/// Of a count in a float WAV: 2^(1 - bits), by which single precision multiplies exactly.
float PartOfFullScale(std::int64_t bits) { return std::ldexp(1.0F, static_cast<int>(1 - bits)); }

constexpr std::size_t kChunk = 4096;

}  // namespace

class AudioWriter::Impl {
 public:
  Impl(const std::filesystem::path& path, const AudioFormat& format, std::int64_t expected_frames)
      : path_(path), format_(format), rf64_(NeedsRf64(format, expected_frames)) {
    RequireFormat(format);
    file_ = std::make_unique<File>(path, O_RDWR | O_CREAT | O_TRUNC);
    if (!file_->open()) ThrowSystemError(errno);
    SF_INFO info{};
    info.channels = 1;
    info.samplerate = static_cast<int>(format.rate_Hz);
    info.format = SndfileFormat(format, rf64_);
    SF_VIRTUAL_IO callbacks = File::Callbacks();
    sndfile_.reset(sf_open_virtual(&callbacks, SFM_WRITE, &info, file_.get()));
    RequireWritten(sndfile_ != nullptr);
    sf_command(sndfile_.get(), SFC_SET_ADD_PEAK_CHUNK, nullptr, SF_FALSE);  // it would hold the time of day
  }

  void Write(std::span<const std::int32_t> counts) {
    if (format_.container == AudioContainer::kFloatWav) {
      WriteScaled(counts, PartOfFullScale(format_.bits), float_chunk_, sf_writef_float);
    } else {
      WriteScaled(counts, PaddingFactor(format_.bits), chunk_, sf_writef_int);
    }
  }

  void Write(std::span<const float> samples) {
    Demand(format_.container == AudioContainer::kFloatWav, "only a float WAV holds any number");
    WriteScaled(samples, 1.0F, float_chunk_, sf_writef_float);
  }

  void Close() {
    if (!sndfile_) return;
    const bool completed = sf_close(sndfile_.release()) == 0;
    file_->CloseDescriptor();
    RequireWritten(completed);
  }

 private:
  /// Chunk by chunk as products with `factor`.
  template <class Sample, class Written, class WriteFrames>
  void WriteScaled(std::span<const Sample> samples, Written factor, std::array<Written, kChunk>& chunk,
                   WriteFrames write_frames) {
    RequireRoom(static_cast<std::int64_t>(samples.size()));
    while (!samples.empty()) {
      const auto part = samples.first(std::min(samples.size(), kChunk));
      std::transform(part.begin(), part.end(), chunk.begin(),
                     [factor](Sample x) { return static_cast<Written>(x) * factor; });
      const auto n = static_cast<sf_count_t>(part.size());
      RequireWritten(write_frames(sndfile_.get(), chunk.data(), n) == n);
      frames_ += n;
      samples = samples.subspan(part.size());
    }
  }

  [[noreturn]] void ThrowSystemError(int error) const {
    throw std::system_error(error, std::generic_category(), "cannot write '" + path_.string() + "'");
  }

  void RequireWritten(bool ok) const {
    if (file_->error() != 0) ThrowSystemError(file_->error());
    if (!ok)
      throw std::runtime_error("cannot write '" + path_.string() + "': " + sf_strerror(sndfile_.get()));
  }

  void RequireRoom(std::int64_t more_frames) const {
    if (rf64_ || !NeedsRf64(format_, frames_ + more_frames)) return;
    throw std::length_error("'" + path_.string() + "' outgrows the 4 GiB of a WAV file; expect " +
                            std::to_string(frames_ + more_frames) + " frames or write FLAC");
  }

  std::filesystem::path path_;
  AudioFormat format_;
  bool rf64_;
  std::unique_ptr<File> file_;  // outlives sndfile_, which writes to it until it is closed
  SndfilePtr sndfile_;
  std::int64_t frames_ = 0;
  std::array<std::int32_t, kChunk> chunk_{};
  std::array<float, kChunk> float_chunk_{};
};

AudioWriter::AudioWriter(const std::filesystem::path& path, const AudioFormat& format,
                         std::int64_t expected_frames)
    : impl_(std::make_unique<Impl>(path, format, expected_frames)) {}
AudioWriter::~AudioWriter() = default;
AudioWriter::AudioWriter(AudioWriter&&) noexcept = default;

void AudioWriter::Write(std::span<const std::int32_t> counts) { impl_->Write(counts); }
void AudioWriter::Write(std::span<const float> samples) { impl_->Write(samples); }
void AudioWriter::Close() { impl_->Close(); }

class AudioReader::Impl {
 public:
  Impl(const std::filesystem::path& path, std::int64_t float_bits) : path_(path), file_(path, O_RDONLY) {
    if (!file_.open()) Fail(std::generic_category().message(errno));
    SF_INFO info{};
    SF_VIRTUAL_IO callbacks = File::Callbacks();
    sndfile_.reset(sf_open_virtual(&callbacks, SFM_READ, &info, &file_));
    if (!sndfile_) Fail(std::string("not a readable audio file (") + sf_strerror(nullptr) + ")");
    if (info.channels != 1) Fail(std::to_string(info.channels) + " channels; one is expected");
    const AudioContainer container = Container(info.format);
    const bool is_float = container == AudioContainer::kFloatWav;
    format_ = {container, info.samplerate, is_float ? float_bits : Bits(info.format)};
    frames_ = info.frames;
  }

  const AudioFormat& format() const { return format_; }
  std::int64_t frames() const { return frames_; }

  std::size_t Read(std::span<std::int32_t> counts) {
    const auto wanted = std::min(static_cast<sf_count_t>(counts.size()), frames_ - position_);
    const auto part = counts.first(static_cast<std::size_t>(wanted));
    const std::size_t got =
        format_.container == AudioContainer::kFloatWav ? ReadFloats(part) : ReadInts(part);
    position_ += static_cast<sf_count_t>(got);
    if (got != part.size())
      Fail("ends at frame " + std::to_string(position_) + " of " + std::to_string(frames_));
    return got;
  }

 private:
  [[noreturn]] void Fail(const std::string& problem) const {
    throw InputError("'" + path_.string() + "': " + problem);
  }

  std::size_t ReadInts(std::span<std::int32_t> counts) {
    const auto wanted = static_cast<sf_count_t>(counts.size());
    const auto got = static_cast<std::size_t>(sf_readf_int(sndfile_.get(), counts.data(), wanted));
    const std::int32_t factor = PaddingFactor(format_.bits);
    for (std::int32_t& c : counts.first(got)) c /= factor;
    return got;
  }

  std::size_t ReadFloats(std::span<std::int32_t> counts) {
    float_chunk_.resize(counts.size());
    const auto wanted = static_cast<sf_count_t>(counts.size());
    const auto got = static_cast<std::size_t>(sf_readf_float(sndfile_.get(), float_chunk_.data(), wanted));
    const float part = PartOfFullScale(format_.bits);
    for (std::size_t i = 0; i < got; ++i) {
      const float count = float_chunk_[i] / part;
      if (!(std::abs(count) <= 1 / part) || count != std::nearbyint(count)) {
        Fail("frame " + std::to_string(position_ + static_cast<sf_count_t>(i)) + " is no count of " +
             std::to_string(format_.bits) + " bits");
      }
      counts[i] = static_cast<std::int32_t>(count);
    }
    return got;
  }

  AudioContainer Container(int format) const {
    const bool is_float = (format & SF_FORMAT_SUBMASK) == SF_FORMAT_FLOAT;
    switch (format & SF_FORMAT_TYPEMASK) {
      case SF_FORMAT_WAV:
      case SF_FORMAT_WAVEX:
      case SF_FORMAT_RF64:
        return is_float ? AudioContainer::kFloatWav : AudioContainer::kWav;
      case SF_FORMAT_FLAC:
        return AudioContainer::kFlac;
      default:
        Fail("neither WAV nor FLAC");
    }
  }

  std::int64_t Bits(int format) const {
    const int subtype = format & SF_FORMAT_SUBMASK;
    if (subtype == SF_FORMAT_PCM_16) return 16;
    if (subtype == SF_FORMAT_PCM_24) return 24;
    Fail("the samples are neither whole numbers of 16 or 24 bits nor floats of 32");
  }

  std::filesystem::path path_;
  File file_;
  SndfilePtr sndfile_;
  AudioFormat format_;
  sf_count_t frames_ = 0;
  sf_count_t position_ = 0;
  std::vector<float> float_chunk_;
};

AudioReader::AudioReader(const std::filesystem::path& path, std::int64_t float_bits)
    : impl_(std::make_unique<Impl>(path, float_bits)) {}
AudioReader::~AudioReader() = default;
AudioReader::AudioReader(AudioReader&&) noexcept = default;

const AudioFormat& AudioReader::format() const { return impl_->format(); }
std::int64_t AudioReader::frames() const { return impl_->frames(); }
std::size_t AudioReader::Read(std::span<std::int32_t> counts) { return impl_->Read(counts); }

}  // namespace piperun::acoustics
