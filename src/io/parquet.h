#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace sumogamma {

/// Values of one column, of one kind.
using ParquetValues =
    std::variant<std::vector<double>, std::vector<float>, std::vector<std::string>>;

struct ParquetColumn {
  std::string name;
  ParquetValues values;  ///< of a group; its kind is the column's
};

/// Writes Apache Parquet files (format version 1): flat tables without nulls, plain encoding, a
/// data page a column and group, compressed by zstd, texts as UTF-8. Written under "FILE.part" and
/// renamed by close(), as a table without its end can't be read.
class ParquetWriter {
 public:
  /// The columns' names and kinds; values are left out. Throws Error naming the file.
  ParquetWriter(std::filesystem::path file, std::vector<ParquetColumn> columns);
  ~ParquetWriter();
  ParquetWriter(const ParquetWriter&) = delete;
  ParquetWriter& operator=(const ParquetWriter&) = delete;

  /// A group of rows, all columns of the same length and in the order given to the constructor.
  /// Throws Error naming the file, on a full disk, say.
  void write_group(const std::vector<ParquetColumn>& columns);

  /// Writes the end. Idempotent. Throws Error naming the file.
  void close();

 private:
  struct Chunk {
    std::int64_t offset = 0, plain_size = 0, compressed_size = 0;
  };
  struct Group {
    std::int64_t rows = 0;
    std::vector<Chunk> chunks;
  };
  Chunk write_column(const ParquetColumn& column, std::int64_t rows);
  std::string footer() const;
  void write(std::string_view bytes);
  [[noreturn]] void fail(int error);

  std::filesystem::path file_, temporary_;
  std::vector<ParquetColumn> columns_;
  std::vector<Group> groups_;
  std::FILE* stream_ = nullptr;
  std::int64_t written_ = 0;
};

}  // namespace sumogamma
