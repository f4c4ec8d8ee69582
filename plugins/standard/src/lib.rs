//! Built-in shaders.
#![no_std]
