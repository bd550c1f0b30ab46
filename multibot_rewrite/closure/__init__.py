"""Does a robot close: is what its nodes read sent, what its controllers claim exported?"""
