#pragma once

#include <cstddef>
#include <functional>
#include <memory>

namespace sumogamma {

/// A pool that runs a function over a fixed partition of rows: worker w of n gets [w*rows/n,
/// (w+1)*rows/n). Each row writes only its own output, so results are the same bits for any number
/// of workers.
class Workers {
 public:
  /// count >= 1: threads in use, the calling one included.
  explicit Workers(std::size_t count = 1);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  std::size_t count() const { return count_; }

  /// Calls body(worker, begin, end) once for every worker with rows and waits for all. The first
  /// exception thrown by a body is rethrown here. Does not allocate.
  void for_each_range(
      std::size_t rows,
      const std::function<void(std::size_t worker, std::size_t begin, std::size_t end)>& body);

 private:
  struct Pool;
  std::size_t count_;
  std::unique_ptr<Pool> pool_;
};

}  // namespace sumogamma
