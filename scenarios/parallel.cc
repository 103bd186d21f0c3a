#include "scenarios/parallel.h"

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "scenarios/run.h"

namespace piperun::scenarios {
namespace {

/// Indices given out one by one, and what went wrong at the lowest index: whatever the threads, the same one,
/// as all lower ones have been given out before.
class WorkList {
 public:
  WorkList(int count, const std::atomic<bool>* stop, const std::function<void(int)>& work)
      : count_(count), stop_(stop), work_(work) {}

  void Work() {
    for (int i = next_++; i < count_ && !Stopped(); i = next_++) {
      try {
        work_(i);
        ++done_;
      } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!error_ || i < error_index_) error_ = std::current_exception(), error_index_ = i;
        failed_ = true;
      }
    }
    --working_;
  }

  void Begin(int workers) { working_ = workers; }
  bool working() const { return working_ > 0; }
  double fraction() const { return static_cast<double>(done_) / std::max(1, count_); }
  bool Stopped() const { return failed_ || (stop_ && *stop_); }

  void Conclude() const {
    if (error_) std::rethrow_exception(error_);
    if (Stopped()) throw Interrupted();
  }

 private:
  const int count_;
  const std::atomic<bool>* stop_;
  const std::function<void(int)>& work_;
  std::atomic<int> next_{0}, done_{0}, working_{0};
  std::atomic<bool> failed_{false};
  std::mutex mutex_;
  std::exception_ptr error_;
  int error_index_ = 0;
};

}  // namespace

void RunParallel(int count, int jobs, const std::atomic<bool>* stop, const std::function<void(int)>& work,
                 const std::function<void(double)>& progress) {
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const int workers = std::clamp(jobs > 0 ? jobs : cores, 1, std::max(1, count));
  WorkList list(count, stop, work);
  list.Begin(workers);
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < workers; ++i) threads.emplace_back([&list] { list.Work(); });
    while (list.working()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      if (progress) progress(list.fraction());
    }
  }
  list.Conclude();
}

}  // namespace piperun::scenarios
