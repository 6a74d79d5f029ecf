// SPDX-FileCopyrightText: Rhizodont contributors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "serve/limits.hpp"

#include <httplib.h>

namespace rhizodont::serve {

/// httplib's server with bounds on what a connection may cost: bytes and time of a request's head, time of its body,
/// time of its answer. One request a connection, so that nothing of a refused body is taken for the next request; what
/// the client still sends is passed over before the connection is closed, or it would not see the answer. Requests that
/// httplib gives up without an answer get one.
class BoundedServer : public httplib::Server {
 public:
  explicit BoundedServer(const ServeLimits& limits);

 private:
  bool process_and_close_socket(socket_t socket) override;

  ServeLimits limits_;
};

}  // namespace rhizodont::serve
