//! Numbers and series from a finished result file.
