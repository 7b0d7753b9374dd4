#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/io/error.h"
#include "core/io/input_record.h"
#include "core/io/schema_core.h"
#include "core/io/yaml_document.h"

/// One schema in code drives reading, unit and range checks, defaults, the documentation, the echo
/// (`kingpin check`) and the exported JSON schema (`kingpin schema`).
///
///     struct Rack { double mass; double travel; std::optional<double> preload; };
///     enum class Assistance { kNone, kHydraulic, kElectric };
///     struct Steering {
///       Rack rack;
///       Assistance assistance;
///       std::array<double, 3> outer_joint;
///       io::CurveTable boost;                       // x, y
///       double motor_inertia = 0.0;
///     };
///
///     const io::Schema<Rack>& RackSchema() {
///       static const io::Schema<Rack> schema = [] {
///         io::Schema<Rack> s("rack", "Rack with everything rigidly fixed to it.");
///         s.Quantity("mass", &Rack::mass, "kg", "mass of the rack").Positive();
///         s.Quantity("travel", &Rack::travel, "m", "stop to stop").Positive().Default("150 mm");
///         s.Quantity("preload", &Rack::preload, "N", "yoke force").NonNegative().Optional();
///         return s;
///       }();
///       return schema;
///     }
///
///     io::Schema<Steering> s("steering", "The steering of one car.");
///     s.Section("rack", &Steering::rack, RackSchema(), "the rack");
///     s.Include("rack", ...);                        // as Section, or the name of a YAML file
///     s.Choice("assistance", &Steering::assistance,
///              {{"none", Assistance::kNone, "no power assistance"},
///               {"hydraulic", Assistance::kHydraulic, "boost valve"},
///               {"electric", Assistance::kElectric, "motor on the rack"}}, "power assistance");
///     s.Point("outer_joint", &Steering::outer_joint, "m", "tie rod's outer ball joint");
///     s.Curve("boost", &Steering::boost, {"torque", "N m"}, {"force", "N"}, "boost curve")
///         .Increasing().Monotone().OnlyIf("assistance", {"hydraulic"});
///     s.Quantity("motor_inertia", &Steering::motor_inertia, "kg m^2", "of the motor's rotor")
///         .Positive().OnlyIf("assistance", {"electric"});
///     s.Check([](const Steering& steering, io::Check& check) {
///       if (steering.rack.travel > 0.3) check.Fail("rack.travel", "...", "...");
///     });
///
///     io::InputRecord record;                                              // optional
///     Steering steering = io::ReadFile(s, "steering.yaml", {.overrides = overrides}, &record);
///
/// Every field is required unless it has a Default() or is Optional(): an optional field that is
/// absent leaves its member as it was (nullopt, or what the struct initialises it with). A section
/// that is Optional() is read as an empty mapping where its member is a plain struct (so that its
/// defaults apply) and left at nullopt where it is a std::optional.
///
/// The second argument of each call is a pointer to a member or a function `M& (T&)`.
///
/// A value is written plainly or with its provenance, which travels with it into the record:
///
///     mass: 35 kg
///     mass: {value: 35 kg, source: "weighed", certainty: D, note: "without fluid"}
///
/// Lists and points may add `unit:` for their bare numbers; a curve or table is a list of rows, or
/// `{units: [mm, N], rows: [[...], ...], source: ...}`, or `{file: boost.csv}`.
///
/// Paths: `rack.mass`, `load_cases[0].speed`, `variables.r_L.lower`. `--set path=value` replaces
/// the value at a path (any node, written as YAML) before it is checked.
///
/// All problems of an input are collected and thrown as one InputError, the first one first.
namespace kingpin::io {

/// x over y, e.g. a boost curve.
struct CurveTable {
  std::vector<double> x;
  std::vector<double> y;
};

/// Entries of a mapping whose keys the user chooses, in the user's order.
template <class E>
using NamedList = std::vector<std::pair<std::string, E>>;

template <class E>
struct ChoiceOption {
  std::string name;
  E value;
  std::string description;
};

namespace schema_internal {
template <class M>
struct IsOptional : std::false_type {};
template <class M>
struct IsOptional<std::optional<M>> : std::true_type {};
template <class M>
struct Inner {
  using type = M;
};
template <class M>
struct Inner<std::optional<M>> {
  using type = M;
};
template <class M>
constexpr std::size_t SizeOf() {
  if constexpr (requires { std::tuple_size<M>::value; }) {
    return std::tuple_size<M>::value;
  } else {
    return static_cast<std::size_t>(M::SizeAtCompileTime);  // an Eigen vector
  }
}
}  // namespace schema_internal

template <class T>
class Schema {
 public:
  /// `name` is the kind of a file (`kind: car`) or what a section is called in the documentation.
  Schema(std::string name, std::string description)
      : core_(std::make_shared<SchemaCore>(std::move(name), std::move(description))) {}

  const std::string& name() const { return core_->name(); }
  const std::string& description() const { return core_->description(); }
  const std::shared_ptr<const SchemaCore>& core() const { return core_view_; }

  /// A physical quantity; member double or std::optional<double>. `unit` is SI, e.g. "N m/rad".
  template <class A>
  FieldBuilder Quantity(std::string key, A member, std::string_view unit, std::string description) {
    FieldSpec& field = Add(std::move(key), FieldKind::kQuantity, std::move(description));
    field.SetUnit(unit);
    field.assign = [member](void* object, const FieldValue& value) {
      Get(member, object) = value.number;
    };
    return FieldBuilder(&field);
  }

  /// A whole number; any integer member or an optional one. Limits follow the member's type.
  template <class A>
  FieldBuilder Integer(std::string key, A member, std::string description) {
    using I = typename schema_internal::Inner<Member<A>>::type;
    FieldSpec& field = Add(std::move(key), FieldKind::kInteger, std::move(description));
    // Integers beyond 2^53 are not whole in double; no input needs them.
    constexpr double kLargest = 9007199254740992.0;
    field.min = std::max(static_cast<double>(std::numeric_limits<I>::min()), -kLargest);
    field.max = std::min(static_cast<double>(std::numeric_limits<I>::max()), kLargest);
    field.range_is_of_type = true;
    field.assign = [member](void* object, const FieldValue& value) {
      Get(member, object) = static_cast<I>(value.number);
    };
    return FieldBuilder(&field);
  }

  /// true or false (yes, no, on, off).
  template <class A>
  FieldBuilder Boolean(std::string key, A member, std::string description) {
    FieldSpec& field = Add(std::move(key), FieldKind::kBoolean, std::move(description));
    field.assign = [member](void* object, const FieldValue& value) {
      Get(member, object) = value.boolean;
    };
    return FieldBuilder(&field);
  }

  /// Text that is not empty; member std::string or optional.
  template <class A>
  FieldBuilder Text(std::string key, A member, std::string description) {
    FieldSpec& field = Add(std::move(key), FieldKind::kText, std::move(description));
    field.assign = [member](void* object, const FieldValue& value) {
      Get(member, object) = value.text;
    };
    return FieldBuilder(&field);
  }

  /// A list of texts; member std::vector<std::string>.
  template <class A>
  FieldBuilder Texts(std::string key, A member, std::string description) {
    FieldSpec& field = Add(std::move(key), FieldKind::kTexts, std::move(description));
    field.assign = [member](void* object, const FieldValue& value) {
      Get(member, object) = value.texts;
    };
    return FieldBuilder(&field);
  }

  /// One of several names; member an enumeration (or anything copyable).
  template <class A>
  FieldBuilder Choice(
      std::string key, A member,
      std::vector<ChoiceOption<
          typename schema_internal::Inner<std::remove_cvref_t<std::invoke_result_t<A&, T&>>>::type>>
          options,
      std::string description) {
    FieldSpec& field = Add(std::move(key), FieldKind::kChoice, std::move(description));
    for (const auto& option : options) {
      field.options.push_back(FieldSpec::Option{option.name, option.description});
    }
    field.assign = [member, options = std::move(options)](void* object, const FieldValue& value) {
      Get(member, object) = options[value.choice].value;
    };
    return FieldBuilder(&field);
  }

  /// A file, relative to the file that names it (on the command line: to the current directory). It
  /// must exist. Member std::filesystem::path or optional.
  template <class A>
  FieldBuilder FilePath(std::string key, A member, std::string description) {
    FieldSpec& field = Add(std::move(key), FieldKind::kFile, std::move(description));
    field.assign = [member](void* object, const FieldValue& value) {
      Get(member, object) = std::filesystem::path(value.text);
    };
    return FieldBuilder(&field);
  }

  /// A list of quantities of one unit; member std::vector<double>.
  template <class A>
  FieldBuilder Quantities(std::string key, A member, std::string_view unit,
                          std::string description) {
    FieldSpec& field = Add(std::move(key), FieldKind::kQuantities, std::move(description));
    field.SetUnit(unit);
    field.assign = [member](void* object, const FieldValue& value) {
      Get(member, object) = value.numbers;
    };
    return FieldBuilder(&field);
  }

  /// A list of as many quantities as the member has: std::array<double, N>, a fixed Eigen vector,
  /// or an optional one. `[x, y, z]`.
  template <class A>
  FieldBuilder Point(std::string key, A member, std::string_view unit, std::string description) {
    using P = typename schema_internal::Inner<Member<A>>::type;
    FieldSpec& field = Add(std::move(key), FieldKind::kQuantities, std::move(description));
    field.SetUnit(unit);
    field.min_count = field.max_count = schema_internal::SizeOf<P>();
    field.assign = [member](void* object, const FieldValue& value) {
      P point;
      for (std::size_t i = 0; i < value.numbers.size(); ++i) {
        point[static_cast<decltype(point.size())>(i)] = value.numbers[i];
      }
      Get(member, object) = point;
    };
    return FieldBuilder(&field);
  }

  /// Two columns; member CurveTable or optional. At least two rows.
  template <class A>
  FieldBuilder Curve(std::string key, A member, ColumnSpec x, ColumnSpec y,
                     std::string description) {
    FieldSpec& field = Add(std::move(key), FieldKind::kTable, std::move(description));
    field.AddColumn(std::move(x));
    field.AddColumn(std::move(y));
    field.min_count = 2;
    field.assign = [member](void* object, const FieldValue& value) {
      Get(member, object) = CurveTable{value.columns[0], value.columns[1]};
    };
    return FieldBuilder(&field);
  }

  /// Several columns; member std::vector<std::vector<double>>, one vector for each column.
  template <class A>
  FieldBuilder Table(std::string key, A member, std::vector<ColumnSpec> columns,
                     std::string description) {
    FieldSpec& field = Add(std::move(key), FieldKind::kTable, std::move(description));
    for (ColumnSpec& column : columns) field.AddColumn(std::move(column));
    field.min_count = 1;
    field.assign = [member](void* object, const FieldValue& value) {
      Get(member, object) = value.columns;
    };
    return FieldBuilder(&field);
  }

  /// A nested mapping; member a struct U or std::optional<U>.
  template <class A, class U>
  FieldBuilder Section(std::string key, A member, const Schema<U>& schema,
                       std::string description) {
    return AddSection(std::move(key), std::move(member), schema, std::move(description));
  }

  /// As Section, or the name of a YAML file that holds it, relative to the file that names it.
  template <class A, class U>
  FieldBuilder Include(std::string key, A member, const Schema<U>& schema,
                       std::string description) {
    FieldBuilder builder =
        AddSection(std::move(key), std::move(member), schema, std::move(description));
    builder.field()->may_be_file = true;
    return builder;
  }

  /// A list of mappings; member std::vector<U>.
  template <class A, class U>
  FieldBuilder List(std::string key, A member, const Schema<U>& schema, std::string description) {
    FieldSpec& field = Add(std::move(key), FieldKind::kList, std::move(description));
    field.schema = schema.core();
    field.child = [member](void* object, const std::string&) -> void* {
      return &Get(member, object).emplace_back();
    };
    return FieldBuilder(&field);
  }

  /// A mapping whose keys the user chooses, to mappings; member NamedList<U>.
  template <class A, class U>
  FieldBuilder Map(std::string key, A member, const Schema<U>& schema, std::string description) {
    FieldSpec& field = Add(std::move(key), FieldKind::kMap, std::move(description));
    field.schema = schema.core();
    field.child = [member](void* object, const std::string& name) -> void* {
      auto& entry = Get(member, object).emplace_back();
      entry.first = name;
      return &entry.second;
    };
    return FieldBuilder(&field);
  }

  /// Whatever stands there, unread: for `--set`-like changes of another input, or for a part that
  /// another schema reads. Member NodePointer.
  template <class A>
  FieldBuilder Raw(std::string key, A member, std::string description) {
    FieldSpec& field = Add(std::move(key), FieldKind::kRaw, std::move(description));
    field.assign = [member](void* object, const FieldValue& value) {
      Get(member, object) = value.node;
    };
    return FieldBuilder(&field);
  }

  /// What involves several fields. Runs when each field of this mapping is right by itself.
  void Check(std::function<void(const T&, io::Check&)> check) {
    core_->AddCheck([check = std::move(check)](const void* object, io::Check& context) {
      check(*static_cast<const T*>(object), context);
    });
  }

 private:
  template <class A>
  using Member = std::remove_cvref_t<std::invoke_result_t<A&, T&>>;

  template <class A>
  static auto& Get(const A& member, void* object) {
    return std::invoke(member, *static_cast<T*>(object));
  }

  FieldSpec& Add(std::string key, FieldKind kind, std::string description) {
    return core_->AddField(std::move(key), kind, std::move(description));
  }

  template <class A, class U>
  FieldBuilder AddSection(std::string key, A member, const Schema<U>& schema,
                          std::string description) {
    static_assert(std::is_same_v<typename schema_internal::Inner<Member<A>>::type, U>,
                  "the section's schema is for another type than the member");
    FieldSpec& field = Add(std::move(key), FieldKind::kSection, std::move(description));
    field.schema = schema.core();
    field.stays_absent = schema_internal::IsOptional<Member<A>>::value;
    field.child = [member](void* object, const std::string&) -> void* {
      auto& section = Get(member, object);
      if constexpr (schema_internal::IsOptional<Member<A>>::value) {
        return &section.emplace();
      } else {
        return &section;
      }
    };
    return FieldBuilder(&field);
  }

  std::shared_ptr<SchemaCore> core_;
  std::shared_ptr<const SchemaCore> core_view_ = core_;
};

/// Reads a YAML file. Its `kind:` must be the schema's name. Fills `record` with every value, also
/// when problems are thrown. `T` starts from its own initial values.
template <class T>
T ReadFile(const Schema<T>& schema, const std::filesystem::path& path,
           const ReadOptions& options = {}, InputRecord* record = nullptr) {
  T object{};
  ReadInto(*schema.core(), path, options, &object, record);
  return object;
}

/// The same from text; relative files are looked for beside `name`.
template <class T>
T ReadText(const Schema<T>& schema, std::string_view text, const std::string& name,
           const ReadOptions& options = {}, InputRecord* record = nullptr) {
  T object{};
  ReadInto(*schema.core(), ParseYaml(text, name), options, &object, record);
  return object;
}

}  // namespace kingpin::io
