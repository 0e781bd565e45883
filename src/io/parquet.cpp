#include "io/parquet.h"

#include <zstd.h>

#include <cassert>
#include <cerrno>
#include <cstring>

#include "base/error.h"

namespace sumogamma {

namespace {

constexpr std::string_view kMagic = "PAR1";
// enumerations of parquet.thrift
constexpr std::int64_t kDataPage = 0, kPlain = 0, kRunLength = 3, kRequired = 0, kUtf8 = 0,
                       kZstd = 6, kFloat = 4, kDouble = 5, kByteArray = 6;
constexpr int kLevel = 3;

/// Thrift's compact protocol, as far as Parquet's metadata takes it.
class CompactText {
 public:
  void begin_struct() { last_.push_back(0); }
  void end_struct() {
    text_ += '\0';
    last_.pop_back();
  }
  void number32(int field, std::int64_t value) {
    begin_field(field, 5);
    zigzag(value);
  }
  void number64(int field, std::int64_t value) {
    begin_field(field, 6);
    zigzag(value);
  }
  void text(int field, std::string_view value) {
    begin_field(field, 8);
    bytes(value);
  }
  void begin_inner(int field) {
    begin_field(field, 12);
    begin_struct();
  }
  /// Elements follow: structs, each between begin_struct and end_struct.
  void begin_structs(int field, std::size_t count) { begin_list(field, count, 12); }
  void numbers(int field, std::initializer_list<std::int64_t> values) {
    begin_list(field, values.size(), 5);
    for (const std::int64_t value : values) zigzag(value);
  }
  void texts(int field, std::initializer_list<std::string_view> values) {
    begin_list(field, values.size(), 8);
    for (const std::string_view value : values) bytes(value);
  }
  const std::string& bytes() const { return text_; }

 private:
  void begin_field(int field, int type) {
    text_ += static_cast<char>(((field - last_.back()) << 4) | type);
    last_.back() = field;
  }
  void begin_list(int field, std::size_t count, int type) {
    begin_field(field, 9);
    const std::size_t in_head = count < 15 ? count : 15;
    text_ += static_cast<char>((in_head << 4) | static_cast<std::size_t>(type));
    if (count >= 15) varint(count);
  }
  void bytes(std::string_view value) {
    varint(value.size());
    text_ += value;
  }
  void zigzag(std::int64_t value) {
    varint((static_cast<std::uint64_t>(value) << 1) ^ static_cast<std::uint64_t>(value >> 63));
  }
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) text_ += static_cast<char>((value & 0x7f) | 0x80);
    text_ += static_cast<char>(value);
  }

  std::string text_;
  std::vector<int> last_;  ///< field of each open struct
};

// Parquet is little-endian, and so is every machine that Debian's SUMO runs on here
template <typename Number>
void append_plain(const std::vector<Number>& values, std::string& text) {
  const std::size_t begin = text.size();
  text.resize(begin + values.size() * sizeof(Number));
  if (!values.empty()) std::memcpy(text.data() + begin, values.data(), text.size() - begin);
}

void append_plain(const std::vector<std::string>& values, std::string& text) {
  for (const std::string& value : values) {
    const auto size = static_cast<std::uint32_t>(value.size());
    char head[sizeof size];
    std::memcpy(head, &size, sizeof size);
    text.append(head, sizeof head);
    text += value;
  }
}

std::int64_t type_of_column(const ParquetColumn& column) {
  if (std::holds_alternative<std::vector<double>>(column.values)) return kDouble;
  return std::holds_alternative<std::vector<float>>(column.values) ? kFloat : kByteArray;
}

std::int64_t length_of(const ParquetColumn& column) {
  return static_cast<std::int64_t>(
      std::visit([](const auto& values) { return values.size(); }, column.values));
}

std::string page_header(std::int64_t plain, std::int64_t compressed, std::int64_t rows) {
  CompactText text;
  text.begin_struct();
  text.number32(1, kDataPage);
  text.number32(2, plain);
  text.number32(3, compressed);
  text.begin_inner(5);
  text.number32(1, rows);
  text.number32(2, kPlain);
  text.number32(3, kRunLength);
  text.number32(4, kRunLength);
  text.end_struct();
  text.end_struct();
  return text.bytes();
}

}  // namespace

ParquetWriter::ParquetWriter(std::filesystem::path file, std::vector<ParquetColumn> columns)
    : file_(std::move(file)), temporary_(file_), columns_(std::move(columns)) {
  temporary_ += ".part";
  for (ParquetColumn& column : columns_)
    std::visit([](auto& values) { values.clear(); }, column.values);
  stream_ = std::fopen(temporary_.c_str(), "wbe");
  if (!stream_)
    throw Error(file_.string(), std::string("can't be written (") + std::strerror(errno) + ")");
  write(kMagic);
}

ParquetWriter::~ParquetWriter() {
  if (!stream_) return;
  // not closed: somebody gave up
  std::fclose(stream_);
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

void ParquetWriter::fail(int error) {
  throw Error(file_.string(), std::string("can't be written to its end (") + std::strerror(error) +
                                  "), make room and run again");
}

void ParquetWriter::write(std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), stream_) != bytes.size()) fail(errno);
  written_ += static_cast<std::int64_t>(bytes.size());
}

ParquetWriter::Chunk ParquetWriter::write_column(const ParquetColumn& column, std::int64_t rows) {
  std::string plain;
  std::visit([&](const auto& values) { append_plain(values, plain); }, column.values);
  std::string packed(ZSTD_compressBound(plain.size()), '\0');
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), plain.data(), plain.size(), kLevel);
  if (ZSTD_isError(size) != 0)
    throw Error(file_.string(), std::string("can't be compressed: ") + ZSTD_getErrorName(size));
  packed.resize(size);
  const std::string header =
      page_header(static_cast<std::int64_t>(plain.size()), static_cast<std::int64_t>(size), rows);
  const Chunk chunk{written_, static_cast<std::int64_t>(header.size() + plain.size()),
                    static_cast<std::int64_t>(header.size() + size)};
  write(header);
  write(packed);
  return chunk;
}

void ParquetWriter::write_group(const std::vector<ParquetColumn>& columns) {
  assert(columns.size() == columns_.size());
  Group group;
  group.rows = columns.empty() ? 0 : length_of(columns.front());
  if (group.rows == 0) return;
  for (const ParquetColumn& column : columns) {
    assert(length_of(column) == group.rows);
    group.chunks.push_back(write_column(column, group.rows));
  }
  groups_.push_back(std::move(group));
}

std::string ParquetWriter::footer() const {
  CompactText text;
  std::int64_t rows = 0;
  for (const Group& group : groups_) rows += group.rows;
  text.begin_struct();
  text.number32(1, 1);
  text.begin_structs(2, columns_.size() + 1);
  text.begin_struct();
  text.text(4, "schema");
  text.number32(5, static_cast<std::int64_t>(columns_.size()));
  text.end_struct();
  for (const ParquetColumn& column : columns_) {
    text.begin_struct();
    text.number32(1, type_of_column(column));
    text.number32(3, kRequired);
    text.text(4, column.name);
    if (type_of_column(column) == kByteArray) text.number32(6, kUtf8);
    text.end_struct();
  }
  text.number64(3, rows);
  text.begin_structs(4, groups_.size());
  for (const Group& group : groups_) {
    std::int64_t size = 0;
    text.begin_struct();
    text.begin_structs(1, group.chunks.size());
    for (std::size_t k = 0; k < group.chunks.size(); ++k) {
      const Chunk& chunk = group.chunks[k];
      size += chunk.plain_size;
      text.begin_struct();
      text.number64(2, chunk.offset);
      text.begin_inner(3);
      text.number32(1, type_of_column(columns_[k]));
      text.numbers(2, {kPlain});
      text.texts(3, {columns_[k].name});
      text.number32(4, kZstd);
      text.number64(5, group.rows);
      text.number64(6, chunk.plain_size);
      text.number64(7, chunk.compressed_size);
      text.number64(9, chunk.offset);
      text.end_struct();
      text.end_struct();
    }
    text.number64(2, size);
    text.number64(3, group.rows);
    text.end_struct();
  }
  text.text(6, "sumo-gamma");
  text.end_struct();
  return text.bytes();
}

void ParquetWriter::close() {
  if (!stream_) return;
  const std::string end = footer();
  write(end);
  const auto size = static_cast<std::uint32_t>(end.size());
  char tail[sizeof size];
  std::memcpy(tail, &size, sizeof size);
  write({tail, sizeof tail});
  write(kMagic);
  std::FILE* const stream = stream_;
  stream_ = nullptr;
  if (std::fclose(stream) != 0) fail(errno);
  if (std::rename(temporary_.c_str(), file_.c_str()) != 0) fail(errno);
}

}  // namespace sumogamma
