// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <string>

#include "common/base/timer.h"
#include "serve/confined_folder.h"
#include "serve/run_entries.h"

namespace treefarm {

/// A request's parts that the site uses. Texts are decoded; parts that were not sent are empty.
struct SiteRequest {
    std::string method = "GET", path = "/";
    std::map<std::string, std::string> parameters;
    std::string host, authorization, cookie, if_none_match;
};

struct SiteResponse {
    int status = 200;
    std::string type = "text/plain; charset=utf-8";
    std::string body;
    std::map<std::string, std::string> headers;
};

/// Access rules.
struct SiteAccess {
    std::string token;        ///< required token; "": none, but the Host header must be this machine's
    std::string cookie_name;  ///< cookie in which a browser stores the token
};

/// The site: answers requests about the runs in a folder, or about the folder's own run. Reads files and changes none.
/// Each answer is made at most once in half a second, for any number of readers, so that readers cost a render nothing.
/// Thread-safe.
class Site {
  public:
    Site(ConfinedFolder folder, SiteAccess access, std::function<Here()> here = local_host);

    SiteResponse respond(const SiteRequest& request);

  private:
    struct Answer {
        double made = 0;
        std::string body;
    };

    SiteResponse let_in(const SiteRequest& request);
    SiteResponse page() const;
    SiteResponse status(const std::string& run);
    SiteResponse metrics();
    SiteResponse picture(const SiteRequest& request, const std::string& run) const;
    std::string list();
    std::string remembered(const std::string& name, const std::function<std::string()>& make);

    const ConfinedFolder folder_;
    const SiteAccess access_;
    const std::function<Here()> here_;
    const Timer clock_;
    std::mutex mutex_;
    std::map<std::string, Answer> answers_;
    RunEntries entries_;  ///< of list()
};

}  // namespace treefarm
