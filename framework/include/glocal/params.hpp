// Parameters, said once: a plain struct whose member initialisers are the only defaults, and one describe()
// that names, documents and bounds its fields. The YAML reader, the help, the schema, the reference and the
// writer of effective values are all visitors of that description.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace glocal {

/// What a field is for, in a sentence. Has no default: a field without `.doc` does not compile.
struct Doc {
  consteval Doc(const char* sentence)
      : text(sentence) {}  // NOLINT(google-explicit-constructor): reads as a string
  const char* text;

  /// A sentence that is known when the program runs only, of a strategy in another language. It must outlive
  /// all that is made of it.
  [[nodiscard]] static Doc at_run_time(const std::string& sentence) {
    Doc doc("");
    doc.text = sentence.c_str();
    return doc;
  }
};

/// Who a field is for.
enum class Audience {
  everyone,
  tuner,  ///< What to tune first: few of a strategy's fields.
  expert,
};

/// What a value of a text field was called before.
struct FormerChoice {
  const char* name = "";
  const char* now = "";
};

/// What is known of a field besides its name and type.
struct FieldInfo {
  Doc doc;
  const char* unit = "";  ///< "m", "rad", "deg", "s", "m^2" …; empty for a plain number.
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  double above = -std::numeric_limits<double>::infinity();  ///< Exclusive lower bound.
  std::vector<std::string> choices = {};                    ///< For strings: the allowed values.
  std::size_t min_items = 0;                                ///< For lists; bounds hold for each number in it.
  std::size_t max_items = std::numeric_limits<std::size_t>::max();
  bool may_be_nan =
      false;               ///< Numbers: of files of other programs, which write it for what they do not know.
  bool required = false;   ///< The file must give it.
  bool is_folder = false;  ///< For paths: a folder is needed, not a file.
  bool may_be_folder = false;  ///< For paths: a folder or a file.
  Audience audience = Audience::everyone;
  const char* formerly = "";  ///< What the field was called before; empty if nothing else.
  std::vector<FormerChoice> former_choices = {};  ///< For strings.
};

/// A path from a file: relative to that file, or below the datasets folder with the prefix `data:`.
struct FilePath {
  std::string text;                ///< As written.
  std::filesystem::path resolved;  ///< Where it is; set by the reader.
};

struct YamlNode;

/// A part of an experiment as it is written, which is judged where it is put to use.
struct Written {
  std::shared_ptr<const YamlNode> written = nullptr;  ///< Null if there is none.
};

/// Sets of changes to an experiment by name: {name: {path: value}}.
struct NamedChanges : Written {};

/// Values for paths into an experiment: {path: [value, value]}.
struct ListedChanges : Written {};

/// What to draw values from for paths into an experiment: {path: [low, high]}.
struct RangedChanges : Written {};

/// Seeds: 7, 1..30 or [1, 2, 10..20].
struct SeedList : Written {};

/// Methods or cases of an experiment: a list of names, files and `name: {keys}`, or a map of these. They are
/// put into the experiment before its values are read, so that nothing is left of them here.
struct PartList : Written {};

/// Where the value of a plain field is: of one that is neither a struct, a list of structs nor a strategy. An
/// optional number is `auto` without one: then something else says what it is. Pairs of numbers are segments
/// or way points.
using ValueRef = std::variant<bool*, int*, std::uint64_t*, double*, std::optional<double>*, std::string*,
                              FilePath*, std::vector<double>*, std::vector<std::string>*,
                              std::vector<FilePath>*, std::vector<std::array<double, 2>>*, NamedChanges*,
                              ListedChanges*, RangedChanges*, SeedList*, PartList*>;

template <class T>
concept Plain = std::constructible_from<ValueRef, T*>;

class ParamVisitor;
class RegistryBase;
struct StrategyChoice;

/// A struct with describe(), its type forgotten.
class AnyParams {
 public:
  virtual ~AnyParams() = default;
  virtual void visit(ParamVisitor& visitor) = 0;
  [[nodiscard]] virtual std::unique_ptr<AnyParams> clone() const = 0;
};

/// What a function describes, to which each visitor is given.
template <std::invocable<ParamVisitor&> Describe>
class DescribedBy final : public AnyParams {
 public:
  explicit DescribedBy(Describe describe) : describe_(std::move(describe)) {}
  void visit(ParamVisitor& visitor) override { describe_(visitor); }
  [[nodiscard]] std::unique_ptr<AnyParams> clone() const override {
    return std::make_unique<DescribedBy>(*this);
  }

 private:
  Describe describe_;
};

/// A list of structs, its type forgotten.
class AnyList {
 public:
  virtual ~AnyList() = default;
  [[nodiscard]] virtual std::size_t size() const = 0;
  virtual void resize(std::size_t n) = 0;
  virtual void visit(std::size_t i, ParamVisitor& visitor) = 0;
  /// Visits an item with default values that belongs to no list (for help and schema).
  virtual void visit_default(ParamVisitor& visitor) = 0;
};

template <class T>
concept Described = requires(ParamVisitor& visitor, T& value) {
  describe(visitor, value);
};

class ParamVisitor {
 public:
  virtual ~ParamVisitor() = default;

  template <Plain T>
  void field(std::string_view name, T& value, const FieldInfo& info) {
    plain(name, &value, info);
  }

  /// A struct within a struct.
  template <Described T>
  void field(std::string_view name, T& value, const FieldInfo& info) {
    DescribedBy params([&value](ParamVisitor& visitor) { describe(visitor, value); });
    group(name, params, info);
  }

  /// A list of structs; those that are read begin as copies of `fresh`.
  template <Described T>
  void field(std::string_view name, std::vector<T>& values, const FieldInfo& info, const T& fresh = {}) {
    struct Ref final : AnyList {
      Ref(std::vector<T>& v, const T& begin) : target(&v), fresh_item(begin) {}
      std::size_t size() const override { return target->size(); }
      void resize(std::size_t n) override { target->resize(n, fresh_item); }
      void visit(std::size_t i, ParamVisitor& visitor) override { describe(visitor, (*target)[i]); }
      void visit_default(ParamVisitor& visitor) override {
        T item = fresh_item;
        describe(visitor, item);
      }
      std::vector<T>* target;
      const T& fresh_item;
    } ref(values, fresh);
    list(name, ref, info);
  }

  /// One strategy of a registry with its parameters: a bare name, or `name: {parameters}`.
  virtual void strategy(std::string_view name, StrategyChoice& choice, const RegistryBase& registry,
                        const FieldInfo& info) = 0;

  /// A rule that spans fields, stated after them: `rule` is reported at `field` if it does not hold.
  /// Only visitors that take values in check it.
  virtual void require(bool /*holds*/, std::string_view /*field*/, std::string_view /*rule*/) {}

  /// A field that is gone: whoever still gives it is told what to do instead.
  virtual void removed(std::string_view /*name*/, std::string_view /*advice*/) {}

 protected:
  virtual void plain(std::string_view name, ValueRef value, const FieldInfo& info) = 0;
  virtual void group(std::string_view name, AnyParams& params, const FieldInfo& info) = 0;
  virtual void list(std::string_view name, AnyList& list, const FieldInfo& info) = 0;
};

/// Owns a parameter struct.
template <Described T>
class ParamsOf final : public AnyParams {
 public:
  void visit(ParamVisitor& visitor) override { describe(visitor, value); }
  [[nodiscard]] std::unique_ptr<AnyParams> clone() const override {
    return std::make_unique<ParamsOf>(*this);
  }
  T value;
};

/// Of a strategy that has none.
struct NoParams {};
inline void describe(ParamVisitor& /*v*/, NoParams& /*p*/) {}

/// Owns parameters of some strategy, or none; a copy owns a copy.
class OwnedParams {
 public:
  OwnedParams() = default;
  template <std::derived_from<AnyParams> T>  // NOLINTNEXTLINE(google-explicit-constructor): as the pointer
                                             // would
  OwnedParams(std::unique_ptr<T> params) : params_(std::move(params)) {}
  OwnedParams(const OwnedParams& other) : params_(other ? other->clone() : nullptr) {}
  OwnedParams(OwnedParams&&) noexcept = default;
  OwnedParams& operator=(const OwnedParams& other) { return *this = OwnedParams(other); }
  OwnedParams& operator=(OwnedParams&&) noexcept = default;
  ~OwnedParams() = default;

  explicit operator bool() const { return params_ != nullptr; }
  AnyParams& operator*() const { return *params_; }
  AnyParams* operator->() const { return params_.get(); }

 private:
  std::unique_ptr<AnyParams> params_;
};

/// A strategy picked by name, with its own parameters: without any, its defaults.
struct StrategyChoice {
  std::string name;
  OwnedParams params = {};
};

}  // namespace glocal
