#include "base/parallel.h"

#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace sumogamma {

namespace {

// Waking a thread that sleeps takes longer than a loop over a hundred agents, and a tick has a
// dozen such loops one after the other: who waits looks about for some 50 us before it goes to
// sleep. It doesn't yield meanwhile: on a busy machine that would give a whole time slice away.
constexpr int kLooks = 1000;

void pause() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#endif
}

template <typename Happened>
bool look_about_for(const Happened& happened) {
  for (int look = 0; look < kLooks; ++look) {
    if (happened()) return true;
    pause();
  }
  return happened();
}

std::size_t range_begin(std::size_t worker, std::size_t count, std::size_t rows) {
  return worker * rows / count;
}

}  // namespace

struct Workers::Pool {
  std::mutex mutex;
  std::condition_variable work_ready;
  std::condition_variable work_done;
  // written while nobody works; a new generation makes them known
  const std::function<void(std::size_t, std::size_t, std::size_t)>* body = nullptr;
  std::size_t rows = 0;
  std::atomic<std::size_t> generation = 0;
  std::atomic<std::size_t> pending = 0;
  std::atomic<bool> stopping = false;
  std::exception_ptr failure;  // the mutex's
  std::vector<std::thread> threads;

  template <typename Happened>
  void wait(std::condition_variable& signal, const Happened& happened) {
    if (look_about_for(happened)) return;
    std::unique_lock lock(mutex);
    signal.wait(lock, happened);
  }
  void work(std::size_t worker, std::size_t count);
};

void Workers::Pool::work(std::size_t worker, std::size_t count) {
  for (std::size_t seen = 0;; ++seen) {
    wait(work_ready, [&] { return stopping || generation != seen; });
    if (stopping) return;
    try {
      const std::size_t begin = range_begin(worker, count, rows);
      const std::size_t end = range_begin(worker + 1, count, rows);
      if (begin < end) (*body)(worker, begin, end);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
    }
    if (--pending > 0) continue;
    const std::lock_guard lock(mutex);  // who is about to sleep sleeps, and is woken
    work_done.notify_one();
  }
}

Workers::Workers(std::size_t count) : count_(count == 0 ? 1 : count) {
  if (count_ == 1) return;
  pool_ = std::make_unique<Pool>();
  for (std::size_t worker = 1; worker < count_; ++worker)
    pool_->threads.emplace_back([this, worker] { pool_->work(worker, count_); });
}

Workers::~Workers() {
  if (!pool_) return;
  {
    const std::lock_guard lock(pool_->mutex);
    pool_->stopping = true;
  }
  pool_->work_ready.notify_all();
  for (std::thread& thread : pool_->threads) thread.join();
}

void Workers::for_each_range(
    std::size_t rows, const std::function<void(std::size_t, std::size_t, std::size_t)>& body) {
  if (rows == 0) return;
  if (!pool_) {
    body(0, 0, rows);
    return;
  }
  Pool& pool = *pool_;
  pool.body = &body;
  pool.rows = rows;
  pool.failure = nullptr;
  pool.pending = count_ - 1;
  {
    const std::lock_guard lock(pool.mutex);
    ++pool.generation;
  }
  pool.work_ready.notify_all();
  std::exception_ptr own_failure;
  try {
    const std::size_t end = range_begin(1, count_, rows);
    if (end > 0) body(0, 0, end);
  } catch (...) {
    own_failure = std::current_exception();
  }
  pool.wait(pool.work_done, [&] { return pool.pending == 0; });
  if (own_failure) std::rethrow_exception(own_failure);
  if (pool.failure) std::rethrow_exception(pool.failure);
}

}  // namespace sumogamma
