"""Files beside a description that name what it declares: the same rename map, the same care."""
