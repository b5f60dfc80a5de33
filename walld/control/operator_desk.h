// SPDX-License-Identifier: MIT
// Carries out what people ask for (wallctl, HTTP): verbs with JSON arguments. Whether they may is decided here, and who
// changed what goes to the log. One thread.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "common/daemon/changed.h"
#include "walld/control/description_desk.h"
#include "walld/control/layout_store.h"
#include "walld/control/machine_desk.h"
#include "walld/control/tokens.h"
#include "walld/streams/snapshot_desk.h"
#include "walld/streams/stream_hub.h"
#include "walld/wall/person.h"
#include "walld/wall/wall.h"

namespace wall::walld {

namespace asio = boost::asio;

/// A request, and where it came from.
struct Asked {
    std::string verb;
    nlohmann::json arguments = nlohmann::json::object();
    Person who;
    const char* via = "";  ///< "control", "http": for the log
};

struct Answer {
    nlohmann::json json = nlohmann::json::object();
    Png blob;  ///< none: null
};

class OperatorDesk {
public:
    /// `end_session` cuts a client off. `changed` is notified after every event of the wall.
    OperatorDesk(Wall& wall, SnapshotDesk& snapshots, const StreamHub& streams, LayoutStore layouts,
                 MachineDesk& machines, Tokens& tokens, DescriptionDesk& description, net::Changed& changed,
                 std::function<void(SessionId, const std::string& reason)> end_session)
        : wall_(wall),
          snapshots_(snapshots),
          streams_(streams),
          layouts_(std::move(layouts)),
          machines_(machines),
          tokens_(tokens),
          description_(description),
          changed_(changed),
          end_session_(std::move(end_session)) {}

    asio::awaitable<Outcome<Answer>> carry_out(Asked asked);
    /// Whether that person may ask for that now.
    Outcome<void> permits(const Asked& asked) const;
    /// Where the status page is, for the status. `certificate`: what a browser shows of it.
    void tell_page(const std::vector<std::string>& urls, const std::string& certificate) {
        page_ = {{"urls", urls}, {"certificate", certificate}};
    }

private:
    using Verb = asio::awaitable<Outcome<Answer>> (OperatorDesk::*)(const Asked&);
    struct Row {
        const char* name;
        Need need;
        Verb run;
    };
    static const Row kVerbs[];

    Outcome<void> allowed(const Row& row, const Asked& asked) const;
    Outcome<const Row*> row_of(const Asked& asked) const;
    asio::awaitable<Outcome<void>> wait_for_session(const Asked& asked);

    asio::awaitable<Outcome<Answer>> status(const Asked&);
    asio::awaitable<Outcome<Answer>> nodes(const Asked&);
    asio::awaitable<Outcome<Answer>> tiles(const Asked&);
    asio::awaitable<Outcome<Answer>> sessions(const Asked&);
    asio::awaitable<Outcome<Answer>> session(const Asked&);
    asio::awaitable<Outcome<Answer>> streams(const Asked&);
    asio::awaitable<Outcome<Answer>> whoami(const Asked&);
    asio::awaitable<Outcome<Answer>> place(const Asked&);
    asio::awaitable<Outcome<Answer>> raise(const Asked&);
    asio::awaitable<Outcome<Answer>> lower(const Asked&);
    asio::awaitable<Outcome<Answer>> close(const Asked&);
    asio::awaitable<Outcome<Answer>> screenshot(const Asked&);
    asio::awaitable<Outcome<Answer>> pattern(const Asked&);
    asio::awaitable<Outcome<Answer>> hold(const Asked&);
    asio::awaitable<Outcome<Answer>> step(const Asked&);
    asio::awaitable<Outcome<Answer>> weight(const Asked&);
    asio::awaitable<Outcome<Answer>> stereo(const Asked&);
    asio::awaitable<Outcome<Answer>> move(const Asked&);
    asio::awaitable<Outcome<Answer>> record(const Asked&);
    asio::awaitable<Outcome<Answer>> wait(const Asked&);
    asio::awaitable<Outcome<Answer>> layouts(const Asked&);
    asio::awaitable<Outcome<Answer>> layout(const Asked&);
    asio::awaitable<Outcome<Answer>> save_layout(const Asked&);
    asio::awaitable<Outcome<Answer>> load_layout(const Asked&);
    asio::awaitable<Outcome<Answer>> delete_layout(const Asked&);
    asio::awaitable<Outcome<Answer>> machines(const Asked&);
    asio::awaitable<Outcome<Answer>> join_token(const Asked&);
    asio::awaitable<Outcome<Answer>> revoke(const Asked&);
    asio::awaitable<Outcome<Answer>> tokens(const Asked&);
    asio::awaitable<Outcome<Answer>> revoke_token(const Asked&);
    asio::awaitable<Outcome<Answer>> reload(const Asked&);
    asio::awaitable<Outcome<Answer>> add_node(const Asked&);
    asio::awaitable<Outcome<Answer>> remove_node(const Asked&);
    asio::awaitable<Outcome<Answer>> drain_node(const Asked&);
    asio::awaitable<Outcome<Answer>> undrain_node(const Asked&);

    Wall& wall_;
    SnapshotDesk& snapshots_;
    Quota pictures_{kPictures};
    const StreamHub& streams_;
    LayoutStore layouts_;
    MachineDesk& machines_;
    Tokens& tokens_;
    DescriptionDesk& description_;
    net::Changed& changed_;
    std::function<void(SessionId, const std::string& reason)> end_session_;
    nlohmann::json page_ = nlohmann::json::object();
};

}  // namespace wall::walld
