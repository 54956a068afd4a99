//! `termtrace serve`: scenes for everyone who connects by SSH.

#[cfg(feature = "serve")]
mod server;

#[cfg(not(feature = "serve"))]
mod without;

#[cfg(feature = "serve")]
pub(super) use server::{ServeArgs, run};
#[cfg(not(feature = "serve"))]
pub(super) use without::{ServeArgs, run};
