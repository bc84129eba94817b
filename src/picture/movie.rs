//! stub
pub struct Movie;
