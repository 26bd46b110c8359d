// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <thread>

#include "cli/commands.h"
#include "cli/option_values.h"
#include "common/base/host.h"
#include "common/base/interrupt.h"
#include "common/base/refuse.h"
#include "serve/site.h"
#include "serve/token.h"
#include "serve/web_server.h"

namespace treefarm {

namespace {

struct ServeOptions {
    std::string folder;
    int port = 7878;
    std::string address = "127.0.0.1";
    std::string token_file;
};

/// Host part of the address as another machine's browser would write it.
std::string host_of(const std::string& address) {
    if (address == "0.0.0.0" || address == "::") return host_name();
    return address.find(':') == std::string::npos ? address : "[" + address + "]";
}

std::string token_for(const ServeOptions& options) {
    if (!options.token_file.empty()) return read_token(options.token_file);
    return is_loopback(options.address) ? "" : make_token();
}

int serve(const ServeOptions& options) {
    if (!std::filesystem::is_directory(options.folder))
        refuse(options.folder, "is no folder", "name a run directory, or a folder that holds some");
    const std::string token = token_for(options);
    InterruptWatch watch;  // before the threads
    ignore_broken_pipes();
    std::unique_ptr<Site> site;
    WebServer server([&](const SiteRequest& request) { return site->respond(request); });
    const int port = server.bind(options.address, options.port);
    site =
        std::make_unique<Site>(ConfinedFolder(options.folder), SiteAccess{token, "treefarm-" + std::to_string(port)});
    server.start();
    std::cout << "serving " << options.folder << " at http://" << host_of(options.address) << ":" << port << "/"
              << (token.empty() || !options.token_file.empty() ? "" : "?token=" + token) << " (Ctrl-C ends)"
              << std::endl;
    if (!options.token_file.empty()) std::cout << "it asks for the token in " << options.token_file << std::endl;
    while (!watch.interrupted())
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    server.stop();
    return 0;
}

}  // namespace

void add_serve_command(CLI::App& app, const LaunchEnvironment& launch, int& exit_code) {
    const auto options = std::make_shared<ServeOptions>();
    CLI::App* command = app.add_subcommand("serve", "Shows renders in a browser while they run, and after");
    command->add_option("folder", options->folder, "a run directory, or a folder that holds some")->required();
    add_integer_option(*command, "--port", options->port, {0, 65535, "a port", "7878"},
                       "port to listen on; 0: any free one (default: 7878)");
    add_text_option(*command, "--address", options->address,
                    "address to listen on; any but the loopback requires a token (default: 127.0.0.1)");
    add_text_option(*command, "--token", options->token_file,
                    "file with the required token (default: a new one, printed; none on the loopback)");
    command->footer(
        "It reads run directories and changes nothing. /status.json and /metrics are for programs.\n"
        "Exit codes: 0 ended by a signal, 2 bad usage or input");
    command->callback([options, launch, &exit_code] {
        if (launch.rank == 0) exit_code = serve(*options);
    });
}

}  // namespace treefarm
