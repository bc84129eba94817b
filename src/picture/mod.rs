//! Pictures and charts made by software, without a display.
