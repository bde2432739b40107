LEFT_IN = ""
