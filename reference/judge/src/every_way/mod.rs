//! Our culler under judgement: rounds over every way that it culls ([`rounds`]), and as a subject
//! like any other program ([`subject`]).

pub mod rounds;
pub mod subject;
