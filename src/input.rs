//! Bytes from a terminal -> events.
