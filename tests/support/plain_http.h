// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

namespace treefarm::test {

/// A raw connection to a port of this machine, for tests that misbehave.
class Client {
  public:
    explicit Client(int port);
    ~Client();
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    bool connected() const { return connected_; }
    void send(const std::string& bytes);
    /// Receives until the other side closes, for `seconds` at most.
    std::string receive(double seconds);

  private:
    int socket_;
    bool connected_ = false;
};

/// A response, parsed strictly.
struct HttpAnswer {
    int status = 0;  ///< 0: no valid response
    std::map<std::string, std::string> headers;
    std::string body;
};
HttpAnswer parse_answer(const std::string& bytes);

/// Sends one request ("GET /metrics") with additional header lines ("Cookie: a=b\r\n") and returns its response.
HttpAnswer ask(int port, const std::string& request, const std::string& headers = "");

}  // namespace treefarm::test
