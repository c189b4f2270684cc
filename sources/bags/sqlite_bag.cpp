#include <fmt/format.h>
#include <sqlite3.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <optional>
#include <utility>

#include "glocal/error.hpp"
#include "glocal/limits.hpp"
#include "sources/bags/recording_file.hpp"
#include "sources/bags/unpacked.hpp"

namespace glocal::bags {
namespace {

class SqliteBag final : public RecordingFile {
 public:
  SqliteBag(const std::filesystem::path& file, Reading reading)
      : name_(file.string()), reading_(std::move(reading)) {
    const std::optional<ConfigError> beside = fault_beside();
    try {
      open();
      require_table("topics");
      require_table("messages");
      read_topics();
      count_rows();
    } catch (const ConfigError&) {
      if (beside) throw *beside;  // Which is why, perhaps.
      throw;
    }
    if (beside) reading_.note_damage(*beside, "only what is in the file itself is read");
  }

  [[nodiscard]] const char* format() const override { return "ROS 2 bag (SQLite)"; }

  void rewind(const std::vector<bool>& wanted) override {
    wanted_ = wanted;
    rows_read_ = 0;
    messages_ = prepare("SELECT id, topic_id, timestamp, data FROM messages ORDER BY timestamp, id");
  }

  [[nodiscard]] std::optional<FileMessage> next() override {
    while (step_if_whole()) {
      sqlite3_stmt* row = messages_.get();
      ++rows_read_;
      const std::int64_t id = sqlite3_column_int64(row, 0);
      const Place place{name_, 0, std::nullopt, id};
      const auto topic = ids_.find(sqlite3_column_int64(row, 1));
      if (topic == ids_.end())
        place.refuse(0, fmt::format("the message is of topic {}, which the table of topics does not have",
                                    sqlite3_column_int64(row, 1)));
      if (!wanted_[topic->second]) continue;
      const std::int64_t stamp_ns = sqlite3_column_int64(row, 2);
      if (const std::string fault = fault_of_stamp_ns(stamp_ns); !fault.empty()) place.refuse(0, fault);
      return FileMessage{topic->second, stamp_ns, blob(row, 3), place};
    }
    return std::nullopt;
  }

  [[nodiscard]] double share_read() const override {
    return rows_ > 0 ? std::min(1.0, static_cast<double>(rows_read_) / static_cast<double>(rows_)) : 1.0;
  }

 private:
  using Statement = std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)>;

  void open() {
    sqlite3* database = nullptr;
    const int answer =
        sqlite3_open_v2(uri().c_str(), &database, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
    database_.reset(database);
    if (answer != SQLITE_OK) refuse("cannot be opened");
    sqlite3_limit(database, SQLITE_LIMIT_LENGTH, static_cast<int>(largest_chunk));
    // What the file brings along is data, not code.
    sqlite3_db_config(database, SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
    sqlite3_db_config(database, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
    sqlite3_exec(database, "PRAGMA cell_size_check = ON", nullptr, nullptr, nullptr);
  }

  /// What SQLite keeps in a file of its own until a recorder ends, and leaves there if that is killed. To
  /// take it in, SQLite would write beside the recording.
  [[nodiscard]] std::optional<ConfigError> fault_beside() const {
    const auto fault = [&](const std::string& ending, const char* what,
                           const char* query) -> std::optional<ConfigError> {
      const std::string file = std::filesystem::canonical(name_).string() + ending;
      // One that is done with is empty or begins with zeros.
      if (std::ifstream(file, std::ios::binary).get() <= 0) return std::nullopt;
      return ConfigError(name_,
                         fmt::format("'{}' beside it has {}, as its recorder has not ended properly; put "
                                     "them together: sqlite3 {} '{}'",
                                     file, what, name_, query));
    };
    if (auto log = fault("-wal", "messages that it has not", "PRAGMA wal_checkpoint(TRUNCATE)")) return log;
    return fault("-journal", "what was there before an unfinished change", "SELECT count(*) FROM messages");
  }

  /// Immutable: SQLite then makes no files beside it, and reads folders that cannot be written to.
  [[nodiscard]] std::string uri() const {
    std::string escaped;
    for (const char c : std::filesystem::absolute(name_).string()) {
      const bool is_special = c == '%' || c == '?' || c == '#';
      escaped += is_special ? fmt::format("%{:02x}", static_cast<unsigned char>(c)) : std::string(1, c);
    }
    return "file:" + escaped + "?immutable=1";
  }

  [[noreturn]] void refuse(const std::string& what) const {
    const char* const why = database_ ? sqlite3_errmsg(database_.get()) : "no memory";
    throw ConfigError(name_, fmt::format("{} as a bag of ROS 2: {}; get a fresh copy", what, why));
  }

  [[nodiscard]] Statement prepare(const char* query) const {
    sqlite3_stmt* statement = nullptr;
    if (sqlite3_prepare_v2(database_.get(), query, -1, &statement, nullptr) != SQLITE_OK)
      refuse("cannot be read");
    return {statement, sqlite3_finalize};
  }

  /// Whether there is one more row.
  [[nodiscard]] bool step(const Statement& statement) const {
    const int answer = sqlite3_step(statement.get());
    if (answer != SQLITE_ROW && answer != SQLITE_DONE) refuse("cannot be read");
    return answer == SQLITE_ROW;
  }

  /// Whether there is one more message; behind damage there is none.
  [[nodiscard]] bool step_if_whole() {
    try {
      return messages_ && step(messages_);
    } catch (const ConfigError& error) {
      if (rows_read_ == 0) throw;
      reading_.note_damage(error, fmt::format("what comes before is read: {} messages", rows_read_));
      messages_.reset();
      return false;
    }
  }

  static std::string_view blob(sqlite3_stmt* row, int column) {
    const auto* bytes = static_cast<const char*>(sqlite3_column_blob(row, column));
    return bytes == nullptr
               ? std::string_view()
               : std::string_view(bytes, static_cast<std::size_t>(sqlite3_column_bytes(row, column)));
  }

  /// A view under the table's name could compute without end.
  void require_table(const char* table) const {
    const Statement query =
        prepare("SELECT 1 FROM sqlite_master WHERE type = 'table' AND name = ? AND rootpage > 0");
    sqlite3_bind_text(query.get(), 1, table, -1, SQLITE_STATIC);
    if (!step(query))
      throw ConfigError(name_,
                        fmt::format("is an SQLite database without the table '{}' of a bag of ROS 2", table));
  }

  void read_topics() {
    const Statement query = prepare("SELECT id, name, type, serialization_format FROM topics ORDER BY id");
    while (step(query)) {
      ids_.try_emplace(sqlite3_column_int64(query.get(), 0), connections_.size());
      connections_.push_back({std::string(blob(query.get(), 1)), normal_type(blob(query.get(), 2)),
                              std::string(blob(query.get(), 3)), ""});
    }
  }

  /// Their largest number, which is found at once. Rows that were deleted are counted, too.
  void count_rows() {
    const Statement query = prepare("SELECT max(id) FROM messages");
    if (step(query)) rows_ = sqlite3_column_int64(query.get(), 0);
  }

  std::string name_;
  Reading reading_;
  std::unique_ptr<sqlite3, decltype(&sqlite3_close)> database_{nullptr, sqlite3_close};
  Statement messages_{nullptr, sqlite3_finalize};
  std::map<std::int64_t, std::size_t> ids_;
  std::vector<bool> wanted_;
  std::int64_t rows_ = 0, rows_read_ = 0;
};

}  // namespace

bool is_sqlite(std::string_view beginning) {
  return beginning.starts_with(std::string_view("SQLite format 3\0", 16));
}

std::unique_ptr<RecordingFile> open_sqlite_bag(const std::filesystem::path& file, const Reading& reading) {
  return std::make_unique<SqliteBag>(file, reading);
}

}  // namespace glocal::bags
