#include "cli/checkpoint_file.h"

#include <array>
#include <bit>
#include <cerrno>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <system_error>

#include "cli/sha256.h"
#include "cli/text.h"
#include "errors.h"
#include "lightmap/atomic_file.h"
#include "scene/printable.h"

namespace hemirad {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little);

constexpr std::string_view kMagic = "hemirad checkpoint ";
constexpr std::string_view kFormat = "1";
constexpr std::size_t kDigits = 64;  // of a SHA-256
/// Bytes of the line of JSON, some 2000 of ours; an ordered object compares a new member with all
/// before it.
constexpr std::size_t kLongestHead = 1 << 16;

[[noreturn]] void refuse(const fs::path& file, const std::string& reason) {
    throw InputError(printable(file.string() + ": " + reason));
}

Json json_of(const SolveIdentity& identity) {
    Json settings = Json::object();
    for (const auto& [option, value] : identity.settings) settings[option] = value;
    return {{"version", identity.version}, {"scene", identity.scene},   {"mesh", identity.mesh},
            {"kernels", identity.kernels}, {"device", identity.device}, {"settings", settings}};
}

Json json_of(const SolveState& state) {
    return {{"shots", state.shots},
            {"repeated_shots", state.repeated_shots},
            {"least_surplus", state.least_surplus},
            {"most_surplus", state.most_surplus},
            {"unshot", state.unshot.size()},
            {"received", state.received.size()},
            {"escaped", state.escaped.size()},
            {"shots_of", state.shots_of.size()}};
}

SolveIdentity identity_from(const Json& json) {
    SolveIdentity identity{json.at("version"), json.at("scene"),  json.at("mesh"),
                           json.at("kernels"), json.at("device"), {}};
    for (const auto& [option, value] : json.at("settings").items())
        identity.settings.emplace_back(option, value);
    return identity;
}

/// A device may call itself anything; JSON is UTF-8.
constexpr auto kReplacing = Json::error_handler_t::replace;

std::string as_kept(const std::string& text) {
    return Json::parse(Json(text).dump(-1, ' ', false, kReplacing)).get<std::string>();
}

std::string head_of(const Checkpoint& checkpoint) {
    const Json json = {{"made_with", json_of(checkpoint.made_with)},
                       {"tolerance", checkpoint.tolerance},
                       {"state", json_of(checkpoint.state)}};
    return std::string(kMagic) + std::string(kFormat) + "\n" +
           json.dump(-1, ' ', false, kReplacing) + "\n";
}

template <class Number>
std::string_view bytes_of(const std::vector<Number>& numbers) {
    return {reinterpret_cast<const char*>(numbers.data()), numbers.size() * sizeof(Number)};
}

/// Unlike iterators, read() tells of a fault on the way by stream.bad().
void append_rest(std::istream& stream, std::string& content) {
    std::array<char, 1 << 16> block;
    while (stream.read(block.data(), block.size()) || stream.gcount() > 0)
        content.append(block.data(), static_cast<std::size_t>(stream.gcount()));
}

std::string content_of(const fs::path& path) {
    std::error_code fault;
    const auto status = fs::status(path, fault);
    if (!fs::exists(status)) refuse(path, fault.message());
    if (!fs::is_regular_file(status)) refuse(path, "not a regular file");
    std::ifstream stream(path, std::ios::binary);
    if (!stream) refuse(path, std::generic_category().message(errno));
    std::string content(kMagic.size(), '\0');  // whoever passes a film has it refused at once
    stream.read(content.data(), static_cast<std::streamsize>(content.size()));
    content.resize(static_cast<std::size_t>(stream.gcount()));
    if (content == kMagic) append_rest(stream, content);
    if (stream.bad()) refuse(path, "cannot be read");
    return content;
}

/// What lies between the line of the format and the checksum.
std::string_view checked_body(const fs::path& file, std::string_view content) {
    if (!content.starts_with(kMagic)) refuse(file, "not a checkpoint of hemirad");
    const auto line = content.substr(0, content.find('\n'));
    const auto format = line.substr(kMagic.size());
    if (line.size() < content.size() && format != kFormat)
        refuse(file, "a checkpoint of format " + std::string(format.substr(0, 20)) +
                         "; this hemirad reads format " + std::string(kFormat));
    if (content.size() < line.size() + 1 + kDigits) refuse(file, "cut short");
    const auto summed = content.substr(0, content.size() - kDigits);
    Sha256 sum;
    sum.add(summed);
    if (sum.digits() != content.substr(summed.size()))
        refuse(file, "damaged or cut short: its checksum does not fit");
    return summed.substr(line.size() + 1);
}

/// Takes so many numbers off the front.
template <class Number>
std::vector<Number> take(std::string_view& bytes, std::uint64_t count) {
    if (count > bytes.size() / sizeof(Number)) throw InputError("numbers are missing");
    std::vector<Number> numbers(count);
    bytes.copy(reinterpret_cast<char*>(numbers.data()), count * sizeof(Number));
    bytes.remove_prefix(count * sizeof(Number));
    return numbers;
}

/// Elsewhere the library would convert what is no such number.
std::uint64_t count_at(const Json& json, const char* name) {
    const Json& count = json.at(name);
    if (!count.is_number_unsigned()) throw InputError(std::string(name) + " is not a count");
    return count;
}

SolveState state_from(const Json& json, std::string_view numbers) {
    SolveState state;
    state.shots = count_at(json, "shots");
    state.repeated_shots = count_at(json, "repeated_shots");
    state.least_surplus = json.at("least_surplus");
    state.most_surplus = json.at("most_surplus");
    state.unshot = take<float>(numbers, count_at(json, "unshot"));
    state.received = take<float>(numbers, count_at(json, "received"));
    state.received_rest = take<float>(numbers, count_at(json, "received"));
    state.escaped = take<float>(numbers, count_at(json, "escaped"));
    state.shots_of = take<std::uint32_t>(numbers, count_at(json, "shots_of"));
    if (!numbers.empty()) throw InputError("more numbers than it tells of");
    return state;
}

const std::string* value_of(const SolveIdentity& identity, const std::string& option) {
    for (const auto& [name, value] : identity.settings)
        if (name == option) return &value;
    return nullptr;
}

/// The first difference of settings, as "with --salvo 1, not 8".
std::optional<std::string> other_setting(const SolveIdentity& made, const SolveIdentity& solve) {
    for (const auto& [option, value] : solve.settings) {
        const auto* const other = value_of(made, option);
        if (other == nullptr) return "before there was " + option;
        if (*other != value) return "with " + option + " " + *other + ", not " + value;
    }
    return {};
}

std::optional<std::string> difference(const SolveIdentity& made, const SolveIdentity& solve) {
    if (made.version != solve.version)
        return "by hemirad " + made.version + ", not " + solve.version;
    if (made.kernels != solve.kernels) return "with other kernels";
    if (made.scene != solve.scene) return "from another scene, or before this one was changed";
    if (auto setting = other_setting(made, solve)) return setting;
    if (made.mesh != solve.mesh) return "with another mesh of the same scene";
    return {};
}

}  // namespace

void write_checkpoint(const fs::path& file, const Checkpoint& checkpoint) {
    const auto& state = checkpoint.state;
    const auto head = head_of(checkpoint);
    write_atomically(file, [&](std::ostream& out) {
        Sha256 sum;
        for (const std::string_view part :
             {std::string_view(head), bytes_of(state.unshot), bytes_of(state.received),
              bytes_of(state.received_rest), bytes_of(state.escaped), bytes_of(state.shots_of)}) {
            out << part;
            sum.add(part);
        }
        out << sum.digits();
    });
}

Checkpoint read_checkpoint(const fs::path& file) {
    const auto content = content_of(file);
    const auto body = checked_body(file, content);
    const auto head = body.substr(0, body.find('\n'));
    if (head.size() > kLongestHead)
        refuse(file, "no checkpoint that hemirad wrote: its second line has " +
                         std::to_string(head.size()) + " bytes");
    try {
        const auto json = Json::parse(head);
        return {identity_from(json.at("made_with")), json.at("tolerance"),
                state_from(json.at("state"), body.substr(std::min(head.size() + 1, body.size())))};
    } catch (const Json::exception&) {
        refuse(file, "no checkpoint that hemirad wrote: its second line is none of ours");
    } catch (const InputError& fault) {
        refuse(file, std::string("no checkpoint that hemirad wrote: ") + fault.what());
    }
}

void require_no_other_file(const fs::path& file) {
    std::error_code ignored;
    if (!fs::is_regular_file(file, ignored) || fs::file_size(file, ignored) == 0) return;
    std::string start(kMagic.size(), '\0');
    std::ifstream stream(file, std::ios::binary);
    if (!stream) refuse(file, std::generic_category().message(errno));
    if (stream.read(start.data(), static_cast<std::streamsize>(start.size())) && start == kMagic)
        return;
    if (stream.bad()) refuse(file, "cannot be read");
    throw InputError("hemirad: --checkpoint " + file.string() +
                     ": would overwrite what is no checkpoint");
}

void require_same_solve(const fs::path& file, const Checkpoint& checkpoint,
                        const SolveIdentity& solve, double tolerance, std::uint64_t max_shots) {
    if (const auto other = difference(checkpoint.made_with, solve)) refuse(file, "made " + *other);
    if (tolerance > checkpoint.tolerance)
        refuse(file, "made with --tolerance " + number_text(checkpoint.tolerance) +
                         ", not as much as " + number_text(tolerance));
    if (checkpoint.state.shots > max_shots)
        refuse(file, "made after " + counted(checkpoint.state.shots, "shot") +
                         ", more than --max-shots " + std::to_string(max_shots));
}

std::uint64_t shots_of_same_solve(const fs::path& file, const SolveIdentity& solve) try {
    const auto checkpoint = read_checkpoint(file);
    return difference(checkpoint.made_with, solve) ? 0 : checkpoint.state.shots;
} catch (const InputError&) {
    return 0;
}

std::optional<std::string> doubt(const fs::path& file, const Checkpoint& checkpoint,
                                 const SolveIdentity& solve) {
    const auto& made = checkpoint.made_with;
    if (made.device == as_kept(solve.device)) return {};
    return file.string() + ": made on " + made.device + ", not " + solve.device +
           ": the last bits may be other than those of a solve that never stopped";
}

}  // namespace hemirad
