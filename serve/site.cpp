// SPDX-License-Identifier: Apache-2.0
#include "serve/site.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/runs/run_files.h"
#include "serve/file_json.h"
#include "serve/metrics_text.h"
#include "serve/page_assets.h"
#include "serve/run_search.h"
#include "serve/token.h"

namespace treefarm {

namespace {

constexpr double kFreshSeconds = 0.5;
constexpr std::size_t kMostAnswers = 64;
constexpr std::size_t kMostPictureBytes = 64 << 20;
/// Largest number of runs in /metrics: the last written ones.
constexpr std::size_t kMostMeasuredRuns = 100;

SiteResponse refusal(int status, const std::string& why) {
    SiteResponse response;
    response.status = status;
    response.body = why + "\n";
    return response;
}

SiteResponse json_response(std::string body) {
    SiteResponse response;
    response.type = "application/json";
    response.body = std::move(body);
    return response;
}

/// Value of a cookie; "" if it is absent.
std::string cookie_value(const std::string& header, const std::string& name) {
    for (std::size_t begin = 0; begin < header.size();) {
        const std::size_t end = std::min(header.find(';', begin), header.size());
        const std::size_t first = std::min(header.find_first_not_of(' ', begin), end);
        if (header.compare(first, name.size() + 1, name + "=") == 0)
            return header.substr(first + name.size() + 1, end - first - name.size() - 1);
        begin = end + 1;
    }
    return "";
}

std::string parameter(const SiteRequest& request, const char* name) {
    const auto found = request.parameters.find(name);
    return found == request.parameters.end() ? "" : found->second;
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
        text.replace(at, what.size(), by);
    return text;
}

}  // namespace

Site::Site(ConfinedFolder folder, SiteAccess access, std::function<Here()> here)
    : folder_(std::move(folder)), access_(std::move(access)), here_(std::move(here)) {}

SiteResponse Site::respond(const SiteRequest& request) {
    SiteResponse response;
    if (request.method != "GET" && request.method != "HEAD") {
        response = refusal(405, "only GET and HEAD are answered: nothing can be changed here");
        response.headers["Allow"] = "GET, HEAD";
    } else {
        response = let_in(request);
    }
    response.headers["X-Content-Type-Options"] = "nosniff";
    response.headers["Referrer-Policy"] = "no-referrer";  // the referrer would reveal the token
    response.headers["Cross-Origin-Resource-Policy"] = "same-origin";
    response.headers.try_emplace("Cache-Control", "no-store");
    return response;
}

SiteResponse Site::let_in(const SiteRequest& request) {
    const std::string run = parameter(request, "run");
    bool new_cookie = false;
    if (access_.token.empty()) {
        if (!names_loopback(request.host))
            return refusal(403, "this page is for this machine alone: open it as http://localhost:PORT/");
    } else {
        constexpr const char* kBearer = "Bearer ";
        const std::string& bearer = request.authorization;
        const bool has_header = bearer.starts_with(kBearer) && equal_in_constant_time(bearer.substr(7), access_.token);
        const bool has_cookie =
            equal_in_constant_time(cookie_value(request.cookie, access_.cookie_name), access_.token);
        const bool has_parameter = equal_in_constant_time(parameter(request, "token"), access_.token);
        if (!has_header && !has_cookie && !has_parameter) {
            SiteResponse response = refusal(401,
                                            "a token is needed: open the URL that treefarm serve has printed, or "
                                            "send the header Authorization: Bearer TOKEN");
            response.headers["WWW-Authenticate"] = "Bearer";
            return response;
        }
        new_cookie = has_parameter && !has_cookie;
    }
    SiteResponse response;
    if (request.path == "/")
        response = page();
    else if (request.path == "/status.json")
        response = status(run);
    else if (request.path == "/metrics")
        response = metrics();
    else if (request.path == "/preview.png")
        response = picture(request, run);
    else
        response = refusal(404, "there are /, /status.json, /metrics and /preview.png");
    if (new_cookie)
        response.headers["Set-Cookie"] =
            access_.cookie_name + "=" + access_.token + "; HttpOnly; SameSite=Strict; Path=/";
    return response;
}

SiteResponse Site::page() const {
    const std::string nonce = make_token();
    SiteResponse response;
    response.type = "text/html; charset=utf-8";
    response.body = replaced(kWatchPage, "@NONCE@", nonce);
    response.headers["Content-Security-Policy"] =
        "default-src 'none'; img-src 'self' data:; connect-src 'self'; style-src 'nonce-" + nonce +
        "'; script-src 'nonce-" + nonce + "'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";
    return response;
}

SiteResponse Site::status(const std::string& run) {
    if (run.empty() && !is_run(folder_, "")) return json_response(remembered("list", [&] { return list(); }));
    if (!is_run(folder_, run)) return refusal(404, "there is no such run");
    return json_response(remembered("run " + run, [&] { return json_text(run_view(folder_, run, here_())); }));
}

std::string Site::list() {
    const FoundRuns found = find_runs(folder_);
    const FileJson runs = entries_.of(folder_, found.paths, here_());
    std::error_code error;
    const std::string folder = std::filesystem::absolute(folder_.root(), error).lexically_normal().string();
    return json_text({{"kind", "runs"}, {"folder", folder}, {"runs", runs}, {"left_out", found.left_out}});
}

SiteResponse Site::metrics() {
    SiteResponse response;
    response.type = kMetricsType;
    response.body = remembered("metrics", [&] {
        SearchLimits limits;
        limits.runs = kMostMeasuredRuns;
        const Here here = here_();
        std::vector<FileJson> runs;
        for (const std::string& path : find_runs(folder_, limits).paths)
            runs.push_back(run_view(folder_, path, here));
        return metrics_text(runs);
    });
    return response;
}

SiteResponse Site::picture(const SiteRequest& request, const std::string& run) const {
    const std::string path = joined_path(run, kPreviewFile);
    if (!is_run(folder_, run)) return refusal(404, "there is no such run");
    const auto version = folder_.version(path);
    if (!version) return refusal(404, "there is no picture yet");
    SiteResponse response;
    response.headers["ETag"] = "\"" + version->text() + "\"";
    response.headers["Cache-Control"] = "private, no-cache";
    if (request.if_none_match == response.headers["ETag"]) {
        response.status = 304;
        return response;
    }
    auto bytes = folder_.read(path, kMostPictureBytes);
    if (!bytes) return refusal(404, "the picture cannot be read, or has more than 64 MiB");
    response.type = "image/png";
    response.body = std::move(*bytes);
    return response;
}

/// Cached answer, made again if it is older than half a second; other readers wait meanwhile.
std::string Site::remembered(const std::string& name, const std::function<std::string()>& make) {
    const std::lock_guard lock(mutex_);
    const auto found = answers_.find(name);
    if (found != answers_.end() && clock_.seconds() - found->second.made < kFreshSeconds) return found->second.body;
    if (answers_.size() >= kMostAnswers) answers_.clear();
    std::string body = make();
    answers_[name] = {clock_.seconds(), body};
    return body;
}

}  // namespace treefarm
