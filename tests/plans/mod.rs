//! What `auto` chooses, and why.

mod slow_plugin;
