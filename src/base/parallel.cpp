#include "base/parallel.h"

#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace sumogamma {

struct Workers::Pool {
  std::mutex mutex;
  std::condition_variable work_ready;
  std::condition_variable work_done;
  const std::function<void(std::size_t, std::size_t, std::size_t)>* body = nullptr;
  std::size_t rows = 0;
  std::size_t generation = 0;
  std::size_t pending = 0;
  bool stopping = false;
  std::exception_ptr failure;
  std::vector<std::thread> threads;
};

namespace {
std::size_t range_begin(std::size_t worker, std::size_t count, std::size_t rows) {
  return worker * rows / count;
}
}  // namespace

Workers::Workers(std::size_t count) : count_(count == 0 ? 1 : count) {
  if (count_ == 1) return;
  pool_ = std::make_unique<Pool>();
  for (std::size_t worker = 1; worker < count_; ++worker) {
    pool_->threads.emplace_back([this, worker] {
      Pool& pool = *pool_;
      std::size_t seen = 0;
      std::unique_lock lock(pool.mutex);
      for (;;) {
        pool.work_ready.wait(lock, [&] { return pool.stopping || pool.generation != seen; });
        if (pool.stopping) return;
        seen = pool.generation;
        const auto* body = pool.body;
        const std::size_t rows = pool.rows;
        lock.unlock();
        std::exception_ptr failure;
        try {
          const std::size_t begin = range_begin(worker, count_, rows);
          const std::size_t end = range_begin(worker + 1, count_, rows);
          if (begin < end) (*body)(worker, begin, end);
        } catch (...) {
          failure = std::current_exception();
        }
        lock.lock();
        if (failure && !pool.failure) pool.failure = failure;
        if (--pool.pending == 0) pool.work_done.notify_one();
      }
    });
  }
}

Workers::~Workers() {
  if (!pool_) return;
  {
    std::lock_guard lock(pool_->mutex);
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
  {
    std::lock_guard lock(pool.mutex);
    pool.body = &body;
    pool.rows = rows;
    pool.failure = nullptr;
    pool.pending = count_ - 1;
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
  std::unique_lock lock(pool.mutex);
  pool.work_done.wait(lock, [&] { return pool.pending == 0; });
  if (own_failure) std::rethrow_exception(own_failure);
  if (pool.failure) std::rethrow_exception(pool.failure);
}

}  // namespace sumogamma
