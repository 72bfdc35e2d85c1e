//! The plain reference of S-DOP culling: one formula a function, no code shared with the culler.
