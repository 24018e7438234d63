"""Everything that needs no screen: from device bytes to a contact point and the exported config."""
