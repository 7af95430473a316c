pub static ALL: &[forcewright_contract::family::Reproduction] = &[];
